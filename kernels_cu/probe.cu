/* SPDX-License-Identifier: MIT */
/** Entries of the device probe; the bodies are in src/device/probe/probe.h. */
#include "platform.h"

#include "device/probe/probe.h"

SK_KERNEL void probe_rounding(sk_u32 n, SK_GLOBAL const float* tuples, SK_GLOBAL sk_u32* words) {
    const sk_u32 i = sk_global_id();
    if (i < n) sk_probe_rounding(i, n, tuples, words);
}

SK_KERNEL void probe_layout(sk_u32 first, SetkaRay ray, SetkaHit hit, SetkaPrimitive primitive,
                            SetkaTraceCost cost, SetkaBounds bounds, SetkaInstance instance,
                            SetkaGridHeader grid, sk_trace_params params, SkCamera camera,
                            SkMaterial material, SkLight light, SkBackground background,
                            SkSurfacePoint surface, SK_GLOBAL const char* memory, SK_GLOBAL sk_u32* words) {
    sk_probe_layout(first, ray, hit, primitive, cost, bounds, instance, grid, params, camera, material, light,
                    background, surface, memory, words);
}

SK_KERNEL void probe_barrier(sk_u32 first, sk_u32 rounds, SK_GLOBAL sk_u32* words) {
    SK_LOCAL_STORAGE sk_u32 scratch[SK_MAX_GROUP];
    sk_probe_barrier(scratch, first, rounds, words);
}
