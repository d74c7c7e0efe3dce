// One binary for every x86-64: the marked functions exist for AVX-512, AVX2 and the baseline, and
// the fitting one is bound when the program starts. They hold only integer arithmetic and IEEE
// + - * / sqrt without contraction, so each clone gives the same bits.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(LILYTANK_NO_CLONES)
#define LILYTANK_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define LILYTANK_CLONES
#endif
#define LILYTANK_INLINE inline __attribute__((always_inline))
