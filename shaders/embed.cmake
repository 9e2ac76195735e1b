# Writes spirv.h, spirv.cpp and kernel_source.cpp into OUTPUT_FOLDER from the SPIR-V files MODULES and the texts KERNELS
# (paths inside SOURCE_FOLDER). Run by the build: cmake -D... -P embed.cmake.

# A file is replaced only where its content changes, so that nothing is compiled again without need.
function(write_if_different name content)
  file(CONFIGURE OUTPUT ${OUTPUT_FOLDER}/${name} CONTENT "${content}" @ONLY)
  file(TOUCH_NOCREATE ${OUTPUT_FOLDER}/${name})
endfunction()

set(declarations "")
set(definitions "")
foreach(module ${MODULES})
  cmake_path(GET module STEM LAST_ONLY entry_point)
  # Compute shaders go by their name alone, the others by name and stage: a picture has two of the same name.
  string(REGEX REPLACE "\\.comp$" "" name ${entry_point})
  string(REPLACE "." "_" name ${name})
  file(READ ${module} bytes HEX)
  # SPIR-V is a run of 32-bit words, little-endian as glslc writes them.
  string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1u," words "${bytes}")
  string(REGEX REPLACE "((0x[0-9a-f]+u,){10})" "\\1\n    " words "${words}")
  string(APPEND declarations "/// shaders/${entry_point}, compiled and validated.\nstd::span<const std::uint32_t> ${name}();\n")
  string(APPEND definitions "namespace {\nconstexpr std::uint32_t ${name}_words[] = {\n    ${words}};\n}\n"
                            "std::span<const std::uint32_t> ${name}() { return ${name}_words; }\n")
endforeach()
write_if_different(spirv.h "// Made by shaders/embed.cmake: the program's shaders as SPIR-V.
#pragma once

#include <cstdint>
#include <span>

namespace sightlines::spirv {
${declarations}
}  // namespace sightlines::spirv
")
write_if_different(spirv.cpp "#include \"shaders/spirv.h\"

namespace sightlines::spirv {
${definitions}
}  // namespace sightlines::spirv
")

# Each line becomes a string literal of its own: no limit on a literal's length is met, and no text can end it early.
set(cases "")
foreach(kernel ${KERNELS})
  file(READ ${SOURCE_FOLDER}/${kernel} text)
  string(REPLACE "\\" "\\\\" text "${text}")
  string(REPLACE "\"" "\\\"" text "${text}")
  string(REPLACE "\n" "\\n\"\n        \"" text "${text}")
  string(APPEND cases "    if (path == \"${kernel}\")\n        return \"${text}\";\n")
endforeach()
write_if_different(kernel_source.cpp "#include \"shaders/kernel_source.h\"

namespace sightlines {

std::string_view kernel_source(std::string_view path) {
${cases}    return {};
}

}  // namespace sightlines
")
