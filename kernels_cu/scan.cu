/* SPDX-License-Identifier: MIT */
/** Entries of the exclusive scan; the bodies are in src/device/scan.h. */
#include "platform.h"

#include "device/scan.h"

SK_KERNEL void scan_reduce(sk_u32 n, sk_u32 elements, SK_GLOBAL const sk_u32* counts, SK_GLOBAL sk_u64* sums) {
    SK_LOCAL_STORAGE sk_u64 scratch[2 * SK_MAX_GROUP];
    sk_scan_reduce(scratch, n, elements, counts, sums);
}

SK_KERNEL void scan_spine(sk_u32 n, sk_u32 elements, SK_GLOBAL sk_u64* sums) {
    SK_LOCAL_STORAGE sk_u64 scratch[2 * SK_MAX_GROUP];
    sk_scan_spine(scratch, n, elements, sums);
}

SK_KERNEL void scan_apply(sk_u32 n, sk_u32 elements, sk_u32 groups, SK_GLOBAL const sk_u32* counts,
                          SK_GLOBAL const sk_u64* sums, SK_GLOBAL sk_u32* offsets) {
    SK_LOCAL_STORAGE sk_u64 scratch[2 * SK_MAX_GROUP];
    sk_scan_apply(scratch, n, elements, groups, counts, sums, offsets);
}
