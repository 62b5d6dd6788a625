/* SPDX-License-Identifier: MIT */
/** Entries of the bounds reduction; the bodies are in src/device/reduce.h. */
#include "platform.h"

#include "device/reduce.h"

SK_KERNEL void reduce_bounds(sk_u32 n, sk_u32 elements, SK_GLOBAL const float* triangles,
                             SK_GLOBAL sk_u32* partials) {
    SK_LOCAL_STORAGE sk_u32 scratch[SK_BOUNDS_VALUES * SK_MAX_GROUP];
    sk_reduce_bounds(scratch, n, elements, triangles, partials);
}

SK_KERNEL void reduce_bounds_partial(sk_u32 n, sk_u32 elements, SK_GLOBAL const sk_u32* sources,
                                     SK_GLOBAL sk_u32* partials) {
    SK_LOCAL_STORAGE sk_u32 scratch[SK_BOUNDS_VALUES * SK_MAX_GROUP];
    sk_reduce_bounds_partial(scratch, n, elements, sources, partials);
}
