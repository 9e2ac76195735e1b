#!/usr/bin/env bash
# tests/newer_mesa.sh FOLDER: fetches the newest Mesa of the distribution's backports into FOLDER, unless it is there, and
# prints the file by which the Vulkan loader finds its software driver (VK_DRIVER_FILES). Nothing is installed, and the
# machine's own apt is only read: where its sources point to, there the backports are looked for.
set -euo pipefail

folder=$1
log=$folder/log
found() { find "$folder/unpacked" -name 'libvulkan_lvp.so' 2>/dev/null || true; }
give_up() {
    echo "No newer Mesa: $1$([[ -s $log ]] && tail -n 1 "$log" | sed 's/^/ (/; s/$/)/')" >&2
    exit 1
}

rm -f "$log"
mkdir -p "$folder/state/lists/partial" "$folder/cache/archives/partial"
if [[ -z $(found) ]]; then
    command -v apt-get dpkg >/dev/null || give_up "this machine has no apt"
    codename=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
    apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
        sed -n "s/^\([^ ]*\) $codename main$/deb \1 $codename-backports main/p" | head -n 1 >"$folder/sources.list" || true
    [[ -s $folder/sources.list ]] || give_up "apt knows no source of $codename"
    : >"$folder/status"
    apt=(timeout 60 apt-get -q -o Dir::State="$folder/state" -o Dir::State::status="$folder/status"
        -o Dir::Cache="$folder/cache" -o Dir::Etc::SourceList="$folder/sources.list" -o Dir::Etc::SourceParts=/dev/null
        -o Acquire::Languages=none -o Acquire::Retries=0 -o APT::Update::Error-Mode=any)
    "${apt[@]}" update >"$log" 2>&1 || give_up "the backports cannot be reached"
    (cd "$folder" && "${apt[@]}" download mesa-vulkan-drivers) >"$log" 2>&1 || give_up "the backports have none"
    dpkg -x "$folder"/mesa-vulkan-drivers_*.deb "$folder/half" >"$log" 2>&1 || give_up "it cannot be unpacked"
    mv "$folder/half" "$folder/unpacked"
fi
driver=$(found)
[[ -n $driver ]] || give_up "its package has no software driver"
ldd "$driver" 2>/dev/null | grep 'not found' >"$log" && give_up "its driver lacks a library"
echo "{\"file_format_version\": \"1.0.0\", \"ICD\": {\"library_path\": \"$driver\", \"api_version\": \"1.3.0\"}}" >"$folder/icd.json"
echo "$folder/icd.json"
