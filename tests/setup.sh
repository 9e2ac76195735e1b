# What this project needs of a bare Debian 12, installed where it is missing. Sourced by run and tests/run.

packages=(
    # tools
    ccache cmake g++ ninja-build pkg-config glslc spirv-tools
    # libraries
    libvtk9-dev libembree-dev libglm-dev libtinygltf-dev libstb-dev libtbb-dev libhwy-dev libcairo2-dev libfreetype-dev
    nlohmann-json3-dev libcli11-dev libxxhash-dev libvulkan-dev libegl-dev libgl-dev libglew-dev libgtest-dev
    libimgui-dev libglfw3-dev libx11-dev libxcb-shm0-dev libxrandr-dev libfontconfig-dev
    # drivers and fonts that the program looks for when it runs
    mesa-vulkan-drivers libgl1-mesa-dri libegl1 fonts-inter fonts-jetbrains-mono fonts-dejavu-core
    # for tests: shader and API checks, a display, keys and clicks on it, pictures to compare
    vulkan-validationlayers xvfb xdotool x11-utils imagemagick
)

# Prints those of `packages` that are not installed.
missing_packages() {
    local installed
    installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "${packages[@]}" 2>/dev/null |
        sed -n 's/^installed //p') || true
    comm -23 <(printf '%s\n' "${packages[@]}" | sort -u) <(sort -u <<<"$installed")
}

# Installs what is missing; asks apt for nothing where all is there.
install_missing_packages() {
    local missing as_root=()
    mapfile -t missing < <(missing_packages)
    if ((${#missing[@]} == 0)); then return; fi
    if ! command -v apt-get >/dev/null; then
        echo "Missing: ${missing[*]}. This script installs them on Debian only; please install them yourself." >&2
        exit 4
    fi
    if ((EUID != 0)); then
        if ! command -v sudo >/dev/null; then
            echo "Missing: ${missing[*]}. Install them as root (there is no sudo here), then try again." >&2
            exit 4
        fi
        echo "Installing with sudo apt-get: ${missing[*]}" >&2
        as_root=(sudo)
    fi
    quietly "Installing ${#missing[@]} packages" "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive bash -c '
        apt-get update -q && apt-get install -q -y --no-install-recommends "$@"' install "${missing[@]}"
}

# quietly TITLE COMMAND...: one line on standard error, the command's output only where it fails.
quietly() {
    local title=$1 log started=$SECONDS
    shift
    log=$(mktemp)
    echo "$title ..." >&2
    if ! "$@" >"$log" 2>&1; then
        echo "$title failed. The end of its output:" >&2
        tail -n 60 "$log" >&2
        rm -f "$log"
        exit 1
    fi
    rm -f "$log"
    if ((SECONDS - started > 1)); then echo "$title took $((SECONDS - started)) s" >&2; fi
}
