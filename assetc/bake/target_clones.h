// One copy of a function per instruction set, chosen when the program starts; -ffp-contract=off
// keeps their bits equal (tests/assetc/target_clones_test.cpp, which compiles without them). What
// it calls must be inlined, and lambdas are not.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) &&                             \
    !defined(PENUMBRA_NO_CLONES)
#define PENUMBRA_CLONES                                                                            \
    __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define PENUMBRA_CLONES
#endif
#define PENUMBRA_INLINE inline __attribute__((always_inline))
