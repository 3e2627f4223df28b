#pragma once
// Holds the inner loops over the cells of a band, for run_simd. Internal to BandMap.
#include <cstdint>

#include "echopath/base/lanes/simd.h"

namespace echopath::band_loops {

inline constexpr int64_t kLanes = 32;     // chirps side by side
inline constexpr int64_t kFewLanes = 16;  // which divides it, where a loop has more to keep
inline constexpr int64_t kApart = 8;      // between rows of lanes: powers of two would share few sets of the cache

// Looks at kRows rows, which stand `stride` apart.
template <int kRows>
ECHOPATH_INLINE void find_largest_squares(const double* re, const double* im, int64_t stride, int64_t count,
                                          double* __restrict largest) {
  for (int64_t i = 0; i < count; ++i) {
    double most = largest[i];
#pragma GCC unroll 8
    for (int c = 0; c < kRows; ++c) {
      const double a = re[c * stride + i], b = im[c * stride + i], square = a * a + b * b;
      most = square > most ? square : most;
    }
    largest[i] = most;
  }
}

// Adds up the cells of a band, each times a complex factor: lanes [count, re/im, num_lanes + kApart] to out [re/im,
// num_lanes].
ECHOPATH_INLINE void combine_cells(const double* lanes, int64_t num_lanes, int64_t count, const double* factor,
                                   double* __restrict out) {
  const int64_t stride = num_lanes + kApart;
  for (int64_t first = 0; first < num_lanes; first += kLanes) {
    double re[kLanes] = {}, im[kLanes] = {};
    for (int64_t i = 0; i < count; ++i) {
      const double* const cell_re = lanes + 2 * i * stride + first;
      const double* const cell_im = cell_re + stride;
      const double factor_re = factor[2 * i], factor_im = factor[2 * i + 1];
      for (int64_t c = 0; c < kLanes; ++c) {
        re[c] += factor_re * cell_re[c] - factor_im * cell_im[c];
        im[c] += factor_re * cell_im[c] + factor_im * cell_re[c];
      }
    }
    for (int64_t c = 0; c < kLanes; ++c) {
      out[first + c] = re[c];
      out[num_lanes + first + c] = im[c];
    }
  }
}

// Adds to out [1] the real part of the sum over lanes, cells i and distances d of overlap_d g_{i + d} conj(g_i); overlap
// [count, re/im].
ECHOPATH_INLINE void add_overlaps(const double* lanes, int64_t num_lanes, int64_t count, const double* overlap,
                                  double* __restrict out) {
  const int64_t stride = num_lanes + kApart;
  double sum[kFewLanes] = {};
  for (int64_t first = 0; first < num_lanes; first += kFewLanes) {
    for (int64_t i = 0; i < count; ++i) {
      const double* const near = lanes + 2 * i * stride + first;
      double re[kFewLanes] = {}, im[kFewLanes] = {};
      for (int64_t d = 0; i + d < count; ++d) {
        const double* const far = near + 2 * d * stride;
        for (int64_t c = 0; c < kFewLanes; ++c) {
          re[c] += overlap[2 * d] * far[c] - overlap[2 * d + 1] * far[stride + c];
          im[c] += overlap[2 * d] * far[stride + c] + overlap[2 * d + 1] * far[c];
        }
      }
      for (int64_t c = 0; c < kFewLanes; ++c) sum[c] += near[c] * re[c] + near[stride + c] * im[c];
    }
  }
  for (int64_t c = 0; c < kFewLanes; ++c) out[0] += sum[c];
}

// Adds to out [re, im] the sum of some cells, each times a complex factor.
ECHOPATH_INLINE void add_product(const double* re, const double* im, const double* factor_re, const double* factor_im,
                                 int64_t count, double* __restrict out) {
  constexpr int64_t kAtOnce = 8;
  double sum_re[kAtOnce] = {}, sum_im[kAtOnce] = {};
  int64_t i = 0;
  for (; i + kAtOnce <= count; i += kAtOnce) {
    for (int64_t c = 0; c < kAtOnce; ++c) {
      sum_re[c] += factor_re[i + c] * re[i + c] - factor_im[i + c] * im[i + c];
      sum_im[c] += factor_re[i + c] * im[i + c] + factor_im[i + c] * re[i + c];
    }
  }
  for (int64_t c = 0; i < count; ++i, ++c) {
    sum_re[c] += factor_re[i] * re[i] - factor_im[i] * im[i];
    sum_im[c] += factor_re[i] * im[i] + factor_im[i] * re[i];
  }
  for (int64_t c = 0; c < kAtOnce; ++c) {
    out[0] += sum_re[c];
    out[1] += sum_im[c];
  }
}

// Adds the squares of `count` complex values.
ECHOPATH_INLINE void add_squares(const double* values, int64_t count, double* __restrict sum) {
  for (int64_t i = 0; i < count; ++i) sum[i] += values[2 * i] * values[2 * i] + values[2 * i + 1] * values[2 * i + 1];
}

}  // namespace echopath::band_loops
