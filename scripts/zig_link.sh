#!/bin/sh
# The linker that rustc calls for the wheel: Zig's, which links against glibc 2.28's symbols on any
# newer system. Only the last step of the build goes through it, so that everything compiled before
# is shared with the tests (`maturin --zig` compiles all dependencies a second time).
# Zig has no libgcc_s; its libunwind stands in. RIDGEFORM_ZIG_PYTHON is a Python with the package ziglang.
for argument do
    shift
    case $argument in
    -lgcc_s) set -- "$@" -lunwind ;;
    -fuse-ld=*) ;;
    *) set -- "$@" "$argument" ;;
    esac
done
exec "${RIDGEFORM_ZIG_PYTHON:?}" -m ziglang cc -target x86_64-linux-gnu.2.28 "$@"
