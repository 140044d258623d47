#!/usr/bin/env bash
# In the container that wheels are built in (manylinux_2_34, as root): the libraries that realcam is compiled with, of
# which its distribution has none or older ones. tools/make_wheel.py finds their licences by the names of the libraries.
set -euxo pipefail
dnf install -y git libpng-devel ninja-build
sources=$(mktemp -d)

fetch() {  # fetch REPOSITORY TAG
    git clone --quiet --depth 1 --branch "$2" "https://github.com/$1" "$sources/${1#*/}"
}

install() {  # install FOLDER OPTION...
    cmake -G Ninja -S "$sources/$1" -B "$sources/$1/build" -DCMAKE_BUILD_TYPE=Release "${@:2}"
    cmake --build "$sources/$1/build" --target install
}

licence() {  # licence LIBRARY FILE
    mkdir -p "/usr/local/share/licenses/$1"
    cp "$2" "/usr/local/share/licenses/$1/"
}

fetch uxlfoundation/oneTBB v2021.13.0
install oneTBB -DTBB_TEST=OFF
licence libtbb "$sources/oneTBB/LICENSE.txt"
fetch RenderKit/embree v4.3.3
install embree -DEMBREE_TUTORIALS=OFF -DEMBREE_ISPC_SUPPORT=OFF
licence libembree4 "$sources/embree/LICENSE.txt"
fetch google/draco 1.5.7
install draco -DBUILD_SHARED_LIBS=ON
licence libdraco "$sources/draco/LICENSE"
fetch zeux/meshoptimizer v0.25
install meshoptimizer -DMESHOPT_BUILD_SHARED_LIBS=ON
licence libmeshoptimizer "$sources/meshoptimizer/LICENSE.md"
fetch marzer/tomlplusplus v3.4.0
install tomlplusplus
fetch CLIUtils/CLI11 v2.4.2
install CLI11 -DCLI11_BUILD_TESTS=OFF -DCLI11_BUILD_EXAMPLES=OFF -DCLI11_BUILD_DOCS=OFF
printf '/usr/local/lib\n/usr/local/lib64\n' >/etc/ld.so.conf.d/realcam.conf
ldconfig
