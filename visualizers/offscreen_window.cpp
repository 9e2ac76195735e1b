#include "visualizers/offscreen_window.h"

#include <mutex>
#include <string>
#include <utility>

#include <GL/glew.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <vtkCamera.h>
#include <vtkFloatArray.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkUnsignedCharArray.h>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

[[noreturn]] void no_opengl(const std::string& problem) {
    throw EnvironmentError("OpenGL", problem, "install Mesa's EGL and OpenGL drivers (libegl1, libgl1-mesa-dri)");
}

/// An OpenGL context that needs neither a display server nor a surface.
struct EglContext {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;

    EglContext() {
        // The display is the process's, shared by all windows, so it is never terminated.
        display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        if (display == EGL_NO_DISPLAY) no_opengl("EGL has no surfaceless platform here");
        if (!eglInitialize(display, nullptr, nullptr)) no_opengl("EGL could not be started");
        if (!eglBindAPI(EGL_OPENGL_API)) no_opengl("EGL offers no desktop OpenGL here");
        const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint found = 0;
        if (!eglChooseConfig(display, wanted, &config, 1, &found) || found == 0)
            no_opengl("EGL has no configuration for desktop OpenGL");
        for (const auto& [major, minor] : {std::pair{4, 5}, std::pair{3, 2}}) {
            const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION,
                                      major,
                                      EGL_CONTEXT_MINOR_VERSION,
                                      minor,
                                      EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                      EGL_NONE};
            context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
            if (context != EGL_NO_CONTEXT) return;
        }
        no_opengl("no OpenGL 3.2 core context can be made");
    }
    ~EglContext() {
        if (is_current()) eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display, context);
    }
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;

    bool make_current() const {
        // The bound API belongs to the thread: whoever uses the window may be another than who made it.
        return eglBindAPI(EGL_OPENGL_API) && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
    }
    bool is_current() const { return eglBindAPI(EGL_OPENGL_API) && eglGetCurrentContext() == context; }
};

/// VTK's window for contexts made by others. The overrides are what it asks its owner for.
class SurfacelessWindow : public vtkGenericOpenGLRenderWindow {
public:
    static SurfacelessWindow* New();
    vtkTypeMacro(SurfacelessWindow, vtkGenericOpenGLRenderWindow);

    void MakeCurrent() override {
        if (!egl_.make_current()) vtkErrorMacro("the EGL context cannot be made current");
    }
    bool IsCurrent() override { return egl_.is_current(); }
    int SupportsOpenGL() override { return 1; }
    void Start() override {
        MakeCurrent();
        if (!Initialized) OpenGLInit();
        vtkOpenGLRenderWindow::Start();
    }
    void Frame() override {
        MakeCurrent();
        vtkOpenGLRenderWindow::Frame();
    }
    void Finalize() override {
        MakeCurrent();
        vtkGenericOpenGLRenderWindow::Finalize();
    }
    void OpenGLInitContext() override {
        MakeCurrent();
        if (Initialized) return;
        // GLEW keeps one table of pointers for the process; make_offscreen_window lets one window in at a time.
        glewExperimental = GL_TRUE;
        const GLenum result = glewInit();
        // Debian's GLEW is built for GLX: without an X server it says so (4), but has loaded every pointer.
        GlewInitValid = result == GLEW_OK || result == GLEW_ERROR_NO_GLX_DISPLAY;
        if (!GlewInitValid) no_opengl("the OpenGL functions cannot be loaded");
        Initialized = true;
    }
    // The hardware selector and the renderer's alpha need to know; there is no surface that could tell.
    int GetColorBufferSizes(int* rgba) override {
        rgba[0] = rgba[1] = rgba[2] = rgba[3] = 8;
        return 8;
    }
    int GetDepthBufferSize() override { return 24; }

protected:
    SurfacelessWindow() {
        SetFrameBlitModeToNoBlit();
        SetMultiSamples(0);
        SetAlphaBitPlanes(1);
        SetMapped(1);
        SetOwnContext(1);
    }
    ~SurfacelessWindow() override { SurfacelessWindow::Finalize(); }

private:
    EglContext egl_;
};

vtkStandardNewMacro(SurfacelessWindow);

}  // namespace

vtkSmartPointer<vtkRenderWindow> make_offscreen_window() {
    // VTK's object factory sets itself up when it is first asked, without a lock.
    static std::mutex one_at_a_time;
    const std::lock_guard lock(one_at_a_time);
    auto window = vtkSmartPointer<SurfacelessWindow>::New();
    window->OpenGLInit();
    return window;
}

DrawnPixels draw(vtkRenderWindow& window, ImageSize size) {
    window.SetSize(size.width, size.height);
    window.Render();
    vtkNew<vtkUnsignedCharArray> rgba;
    window.GetRGBACharPixelData(0, 0, size.width - 1, size.height - 1, 0, rgba);
    vtkNew<vtkFloatArray> depth;
    window.GetZbufferData(0, 0, size.width - 1, size.height - 1, depth);
    if (rgba->GetNumberOfTuples() != static_cast<vtkIdType>(size.pixels()) ||
        depth->GetNumberOfTuples() != static_cast<vtkIdType>(size.pixels()))
        no_opengl("the drawn picture cannot be read back");

    double clip_m[2] = {0.0, 0.0};
    window.GetRenderers()->GetFirstRenderer()->GetActiveCamera()->GetClippingRange(clip_m);
    const double nearest = 1.0 / clip_m[0], farthest = 1.0 / clip_m[1];
    DrawnPixels drawn{ImageRgba8(size), std::vector<float>(size.pixels())};
    for (int y = 0; y < size.height; ++y) {
        // OpenGL's first row is the lowest.
        const auto from = static_cast<vtkIdType>(size.height - 1 - y) * size.width;
        for (int x = 0; x < size.width; ++x) {
            const unsigned char* const texel = rgba->GetPointer(4 * (from + x));
            drawn.colour.at(x, y) = {texel[0], texel[1], texel[2], texel[3]};
            // Depth values are affine in 1 / z.
            const double z = depth->GetValue(from + x);
            const auto index = static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + x;
            drawn.inverse_depth[index] = z >= 1.0 ? 0.0f : static_cast<float>(nearest + z * (farthest - nearest));
        }
    }
    return drawn;
}

}  // namespace sightlines
