#!/usr/bin/env bash
# Runs a command on this system without what realcam is built with: compilers, headers, Embree, TBB, OpenImageIO, libpng,
# and the folder of the repository. Needs root; the system itself stays as it is.
#   tests/wheel/in_empty_root.sh FOLDER COMMAND...     FOLDER: kept, and empty at first
set -euo pipefail
folder=$(readlink -f "$1")
repository=$(git -C "$(dirname "$(readlink -f "$0")")" rev-parse --show-toplevel)
shift
if [[ ${REALCAM_IN_EMPTY_ROOT:-} != yes ]]; then
    REALCAM_IN_EMPTY_ROOT=yes exec unshare --mount "$(readlink -f "$0")" "$folder" "$@"
fi
layers=$(mktemp -d)
mount -t tmpfs tmpfs "$layers"
mkdir "$layers/upper" "$layers/work" "$layers/nothing" "$layers/kept"
mount -t overlay overlay -o "lowerdir=/usr,upperdir=$layers/upper,workdir=$layers/work" /usr
rm -rf /usr/include /usr/lib/gcc /usr/lib/x86_64-linux-gnu/lib{embree,tbb,OpenImageIO,png,OpenEXR,Imath}* \
    /usr/lib/x86_64-linux-gnu/cmake /usr/local/cuda* /usr/bin/{,*-}{gcc,g++,cpp,cc,c++,clang,clang++,ld,as}{,-[0-9]*} \
    /usr/bin/{cmake,ninja,make}
mount --bind "$folder" "$layers/kept"
mount --bind "$layers/nothing" "$repository"
mount --bind "$layers/kept" "$folder"
cd "$folder"
exec "$@"
