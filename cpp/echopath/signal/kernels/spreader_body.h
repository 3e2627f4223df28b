#pragma once
// Adds echoes to a row of the grid, each with the kernel that nufft_kernel.h describes.
#include "echopath/signal/kernels/cells_body.h"
#include "echopath/signal/kernels/nufft_kernel.h"

namespace echopath::ECHOPATH_KERNELS {
namespace {

// With this many terms of a polynomial, real and imaginary moments fit into the registers.
constexpr int kTermsAtOnce = kLanes == 8 ? 12 : 5;
// From this many echoes in one cell on, their moments are quicker than a kernel for each; for kernels of one vector or two.
constexpr int kFewInCell[] = {3, 2};
// Where runs of one cell have fewer echoes on average, it pays to bring those of a cell together.
constexpr int kShortRun = 4;
// Moments of so many cells stay in the first-level cache beside the places of the echoes.
constexpr int kCellsInTable = 32;
// Echoes of a sorted tile are spread at this many places in turn, because the sum of the last few is not yet ready to load.
constexpr int kStreams = 8;

template <int kWidth>
struct Spreader {
  static constexpr int kPadded = NufftKernel::padded(kWidth), kTerms = NufftKernel::degree(kWidth) + 1;
  static constexpr int kVectors = kPadded / kLanes;
  const double* coefficients;
  int64_t row_length;

  // Adds re and im, which hold the values of the kernel times the amplitude, to the row.
  ECHOPATH_INLINE void add_window(const Vec* re, const Vec* im, double* row) const {
#pragma GCC unroll 8
    for (int v = 0; v < kVectors; ++v) {
      double* out = row + v * kLanes;
      store(out, load(out) + re[v]);
      store(out + row_length, load(out + row_length) + im[v]);
    }
  }

  ECHOPATH_INLINE void add_echo(const Places& places, int p, double* first) const {
    add_at(places.t[p], places.re[p], places.im[p], first + places.cell[p]);
  }
  ECHOPATH_INLINE void add_at(double place, double amplitude_re, double amplitude_im, double* row) const {
    const Vec t = all(place);
    Vec re[kVectors], im[kVectors];
#pragma GCC unroll 8
    for (int v = 0; v < kVectors; ++v) {
      Vec value = load(coefficients + v * kLanes);
#pragma GCC unroll 16
      for (int d = 1; d < kTerms; ++d) value = multiply_add(value, t, load(coefficients + d * kPadded + v * kLanes));
      re[v] = value * amplitude_re;
      im[v] = value * amplitude_im;
    }
    add_window(re, im, row);
  }

  // Holds the sums over echoes of one cell of (re + j im) t^d, d < kTerms.
  struct Moments {
    static constexpr int kRoom = (kTerms + 2 * kLanes - 1) / kLanes * kLanes;  // sums are stored in whole vectors
    alignas(64) double re[kRoom], im[kRoom];

    ECHOPATH_INLINE void clear() {
#pragma GCC unroll 8
      for (int d = 0; d < kRoom; d += kLanes) {
        store(re + d, Vec{});
        store(im + d, Vec{});
      }
    }
  };

  // Adds up to kLanes moments from d on, summed over the lanes; a moment that is left alone is summed with both its parts at
  // once.
  template <int kFirst, int kCount>
  ECHOPATH_INLINE static void add_up(int d, const Vec* moment_re, const Vec* moment_im, Moments& to) {
    double *const re = to.re + kFirst + d, *const im = to.im + kFirst + d;
    if (kLanes > 2 && d + 1 == kCount) {
      const Vec both = sums_of_two(moment_re[d], moment_im[d]);
      *re += both[0];
      *im += both[1];
      return;
    }
    store(re, load(re) + sums(moment_re + d));
    store(im, load(im) + sums(moment_im + d));
  }

  // Adds (re + j im) t^d, kFirst <= d < kFirst + kCount, of an echo in each lane.
  template <int kFirst, int kCount>
  ECHOPATH_INLINE static void add_powers(Vec t, Vec re, Vec im, Vec* sum_re, Vec* sum_im) {
    // Even powers take the amplitude times powers of t^2, odd ones the amplitude times t likewise.
    const Vec square = t * t, re_t = re * t, im_t = im * t;
    Vec power = all(1.0);
#pragma GCC unroll 16
    for (int d = 0; d + 1 < kFirst; d += 2) power = power * square;
#pragma GCC unroll 16
    for (int d = 0; d < kCount; ++d) {
      const bool is_odd = (kFirst + d) % 2 != 0;
      sum_re[d] = multiply_add(power, is_odd ? re_t : re, sum_re[d]);
      sum_im[d] = multiply_add(power, is_odd ? im_t : im, sum_im[d]);
      if (is_odd) power = power * square;
    }
  }

  // Adds terms [kFirst, kFirst + kCount) of echoes [begin, end), which share a cell.
  template <int kFirst, int kCount>
  ECHOPATH_INLINE static void add_moments(const Places& places, int begin, int end, Moments& to) {
    constexpr int kRounded = (kCount + kLanes - 1) / kLanes * kLanes;
    Vec moment_re[kRounded] = {}, moment_im[kRounded] = {};
    Mask lane;
    for (int i = 0; i < kLanes; ++i) lane[i] = i;
    for (int p = begin; p < end; p += kLanes) {
      Vec t = load(places.t + p), re = load(places.re + p), im = load(places.im + p);
      if (end - p < kLanes) {
        const Mask kept = lane < int64_t{end - p};
        t = kept ? t : Vec{};
        re = kept ? re : Vec{};
        im = kept ? im : Vec{};
      }
      add_powers<kFirst, kCount>(t, re, im, moment_re, moment_im);
    }
#pragma GCC unroll 16
    for (int d = 0; d < kCount; d += kLanes) add_up<kFirst, kCount>(d, moment_re, moment_im, to);
    if constexpr (kFirst + kCount < kTerms) {
      constexpr int kNext = kFirst + kCount, kLeft = kTerms - kNext;
      add_moments<kNext, (kLeft < kTermsAtOnce ? kLeft : kTermsAtOnce)>(places, begin, end, to);
    }
  }
  ECHOPATH_INLINE static void add_all_moments(const Places& places, int begin, int end, Moments& to) {
    add_moments<0, (kTerms < kTermsAtOnce ? kTerms : kTermsAtOnce)>(places, begin, end, to);
  }

  // The kernel is a polynomial in t, so the echoes of a cell need its values once.
  ECHOPATH_INLINE void add_kernels(const Moments& moments, Vec* re, Vec* im) const {
    add_kernels_of<1>(moments.re, moments.im, re, im);
  }
  // Moments stand kStep doubles apart.
  template <int kStep>
  ECHOPATH_INLINE void add_kernels_of(const double* moment_re, const double* moment_im, Vec* re, Vec* im) const {
#pragma GCC unroll 16
    for (int d = 0; d < kTerms; ++d) {
#pragma GCC unroll 8
      for (int v = 0; v < kVectors; ++v) {
        const Vec coefficient = load(coefficients + (kTerms - 1 - d) * kPadded + v * kLanes);
        re[v] = multiply_add(coefficient, all(moment_re[d * kStep]), re[v]);
        im[v] = multiply_add(coefficient, all(moment_im[d * kStep]), im[v]);
      }
    }
  }

  ECHOPATH_INLINE void add_run(const Places& places, int begin, int end, double* row) const {
    Moments moments;
    moments.clear();
    add_all_moments(places, begin, end, moments);
    Vec re[kVectors] = {}, im[kVectors] = {};
    add_kernels(moments, re, im);
    add_window(re, im, row);
  }

  // Holds the values of the row that the kernel of one cell reaches. They are not read again from memory for the next cell:
  // what was just written there is not yet ready to load in other parts.
  class Window {
   public:
    ECHOPATH_INLINE Window(double* row, int64_t row_length) : re_(row), im_(row + row_length) {
#pragma GCC unroll 8
      for (int v = 0; v < kVectors; ++v) {
        sum_re_[v] = load(re_ + v * kLanes);
        sum_im_[v] = load(im_ + v * kLanes);
      }
    }

    ECHOPATH_INLINE void add(const Vec* re, const Vec* im) {
#pragma GCC unroll 8
      for (int v = 0; v < kVectors; ++v) {
        sum_re_[v] = sum_re_[v] + re[v];
        sum_im_[v] = sum_im_[v] + im[v];
      }
    }

    // Goes on to the next cell.
    ECHOPATH_INLINE void move() {
      move_part(sum_re_, re_++);
      move_part(sum_im_, im_++);
    }

    ECHOPATH_INLINE void end() {
#pragma GCC unroll 8
      for (int v = 0; v < kVectors; ++v) {
        store(re_ + v * kLanes, sum_re_[v]);
        store(im_ + v * kLanes, sum_im_[v]);
      }
    }

   private:
    ECHOPATH_INLINE static void move_part(Vec* sum, double* at) {
      *at = sum[0][0];
      const Vec next = all(at[kPadded]);
#pragma GCC unroll 8
      for (int v = 0; v < kVectors; ++v) sum[v] = without_first(sum[v], v + 1 < kVectors ? sum[v + 1] : next);
    }

    double *re_, *im_;
    Vec sum_re_[kVectors], sum_im_[kVectors];
  };

  // Adds runs by way of the moments of each cell in the range: a cell to which runs come back needs the kernel and the row
  // but once.
  void add_runs_by_cell(const Places& places, const RunEnds& ends, const FirstCells& cells, double* first) const {
    Moments table[kCellsInTable];
    uint32_t taken = 0;
    for (int c = 0; c < cells.size(); ++c) table[c].clear();
    ends.visit_runs([&](int begin, int end) __attribute__((always_inline)) {
      const int32_t cell = places.cell[begin] - cells.lowest;
      taken |= uint32_t{1} << cell;
      add_all_moments(places, begin, end, table[cell]);
    });
    Window window(first + cells.lowest, row_length);
    for (int c = 0; c < cells.size(); ++c) {
      if (c > 0) window.move();
      if (!(taken >> c & 1)) continue;
      Vec re[kVectors] = {}, im[kVectors] = {};
      add_kernels(table[c], re, im);
      window.add(re, im);
    }
    window.end();
  }
  void add_runs(const Places& places, const RunEnds& ends, double* first) const {
    ends.visit_runs([&](int begin, int end)
                        __attribute__((always_inline)) { add_run(places, begin, end, first + places.cell[begin]); });
  }

  // Adds the echoes that bring_together has sorted.
  void add_cells(const Places& sorted, const CellCounts& counts, double* first) const {
    int begin = 0;
    for (int c = 0; c < counts.num_cells; ++c) {
      const int end = counts.count[c][CellCounts::kCounters - 1];
      if (end > begin) add_run(sorted, begin, end, first + counts.lowest + c);
      begin = end;
    }
  }

  void add_apart(const Places& places, int count, double* first) const {
    const int step = (count + kStreams - 1) / kStreams;
    for (int begin = 0; begin < step; ++begin) {
      for (int p = begin; p < count; p += step) add_echo(places, p, first);
    }
  }
};

template <int kWidth>
void spread_tile(const Spreading& spreading, const Places& places, int count, double* row) {
  constexpr int kFew = kFewInCell[Spreader<kWidth>::kPadded > 8];
  const Spreader<kWidth> spreader{spreading.coefficients, spreading.row_length};
  const RunEnds ends(places.cell, count);
  const int runs = ends.count();
  const FirstCells range = range_of(places.cell, count);
  if (runs * kShortRun > count) {
    CellCounts counts = count_cells(places.cell, range, count);
    if (counts.num_cells <= kCellsOfTile && 2 * counts.num_taken <= runs && counts.num_taken * kFew <= count) {
      Places sorted;
      bring_together(places, count, counts, sorted);
      return spreader.add_cells(sorted, counts, row);
    }
    if (runs * kFew > count) return spreader.add_apart(places, count, row);
  }
  if (range.size() <= kCellsInTable) return spreader.add_runs_by_cell(places, ends, range, row);
  spreader.add_runs(places, ends, row);
}

template <int kWidth>
void spread_any(const Spreading& spreading, const Places& places, int count, const uint32_t* group, Rows rows) {
  const Spreader<kWidth> spreader{spreading.coefficients, spreading.row_length};
  for (int p = 0; p < count; ++p) spreader.add_echo(places, p, rows.of_group[group[p]] + rows.first);
}

// The functions are ordered by width, from the least.
using SpreadTile = void (*)(const Spreading&, const Places&, int, double*);
constexpr SpreadTile kSpreadTile[] = {spread_tile<3>,  spread_tile<4>,  spread_tile<5>,  spread_tile<6>,  spread_tile<7>,
                                      spread_tile<8>,  spread_tile<9>,  spread_tile<10>, spread_tile<11>, spread_tile<12>,
                                      spread_tile<13>, spread_tile<14>, spread_tile<15>, spread_tile<16>};
using SpreadAny = void (*)(const Spreading&, const Places&, int, const uint32_t*, Rows);
constexpr SpreadAny kSpreadAny[] = {spread_any<3>,  spread_any<4>,  spread_any<5>,  spread_any<6>,  spread_any<7>,
                                    spread_any<8>,  spread_any<9>,  spread_any<10>, spread_any<11>, spread_any<12>,
                                    spread_any<13>, spread_any<14>, spread_any<15>, spread_any<16>};

void spread(const Spreading& spreading, const Carriers& carriers, Rows rows) {
  Places places;
  for (int p = 0; p < carriers.count; p += kLanes) {
    locate(spreading, load(carriers.frequency + p), p, places);
    store(places.re + p, load(carriers.re + p));
    store(places.im + p, load(carriers.im + p));
  }
  kSpreadAny[spreading.width - NufftKernel::kMinWidth](spreading, places, carriers.count, carriers.group, rows);
}

}  // namespace
}  // namespace echopath::ECHOPATH_KERNELS
