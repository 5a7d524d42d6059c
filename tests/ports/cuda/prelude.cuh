// What CUDA's own headers bring, for clang without them: keywords, and single-precision functions from instructions of PTX and polynomials (moshier-1989).
//
//     clang -x cuda --cuda-device-only --cuda-gpu-arch=sm_70 -nocudainc -nocudalib -O2 -S -include prelude.cuh answers.cu -o answers.ptx
#pragma once

#ifndef __device__
#define __device__ __attribute__((device))
#define __global__ __attribute__((global))
#endif

// ex2.approx errs by 2^-22 of the value, lg2.approx by 2^-22 absolutely between 1/2 and 2: within what the vectors' single precision grants.
static __device__ inline float expf(float x) { return __nvvm_ex2_approx_f(x * 1.44269504f); }
static __device__ inline float logf(float x) { return __nvvm_lg2_approx_f(x) * 0.693147181f; }
static __device__ inline float sqrtf(float x) { return __nvvm_sqrt_rn_f(x); }
static __device__ inline float ceilf(float x) { return __nvvm_ceil_f(x); }
static __device__ inline float fabsf(float x) { return __nvvm_fabs_f(x); }
static __device__ inline float fminf(float x, float y) { return __nvvm_fmin_f(x, y); }
static __device__ inline float fmaxf(float x, float y) { return __nvvm_fmax_f(x, y); }

// tan x for |x| < pi/2: sine and cosine of the smaller of x and its complement.
static __device__ inline float tanf(float x) {
    const bool is_steep = fabsf(x) > 0.785398163f;
    // pi/2 in two parts.
    const float y = is_steep ? (1.57079637f - fabsf(x)) - 4.37113883e-8f : fabsf(x), z = y * y;
    const float sine = y + y * z * (-1.6666654611e-1f + z * (8.3321608736e-3f + z * -1.9515295891e-4f));
    const float cosine = 1.0f - 0.5f * z + z * z * (4.166664568298827e-2f + z * (-1.388731625493765e-3f + z * 2.443315711809948e-5f));
    const float tangent = is_steep ? cosine / sine : sine / cosine;
    return x < 0.0f ? -tangent : tangent;
}

// atan(y/x) for x > 0.
static __device__ inline float atan2f(float y, float x) {
    const float a = fabsf(y) / x;
    const bool is_large = a > 2.41421356f, is_middle = !is_large && a > 0.414213562f;
    const float t = is_large ? -1.0f / a : is_middle ? (a - 1.0f) / (a + 1.0f) : a, z = t * t;
    const float base = is_large ? 1.57079633f : is_middle ? 0.785398163f : 0.0f;
    const float p = base + (t + t * z * (-3.33329491539e-1f + z * (1.99777106478e-1f + z * (-1.38776856032e-1f + z * 8.05374449538e-2f))));
    return y < 0.0f ? -p : p;
}
