#pragma once
// The inner loops of synthesis, compiled once per instruction set (base/lane_math.h).
#include "echopath/base/lane_math.h"
#include "echopath/base/phasor.h"
#include "echopath/signal/kernels/kernels.h"
#include "echopath/signal/kernels/nufft_kernel.h"
#include "echopath/signal/vecs.h"

namespace echopath::ECHOPATH_KERNELS {
namespace {

// With this many chirps, the echoes of a vector of nodes fit into the registers.
constexpr int kChirpsAtOnce = kLanes == 8 ? 4 : 2;
// With this many terms of a polynomial, real and imaginary moments fit into the registers.
constexpr int kTermsAtOnce = kLanes == 8 ? 12 : 5;
// From this many echoes in one cell on, their moments are quicker than a kernel for each; for kernels of one vector or two.
constexpr int kFewInCell[] = {3, 2};
// Where runs of one cell have fewer echoes on average, it pays to bring those of a cell together, if the tile has few cells.
constexpr int kShortRun = 4;
constexpr int kCellsOfTile = 128;
// Moments of so many cells stay in the first-level cache beside the places of the echoes.
constexpr int kCellsInTable = 32;
// Echoes of a sorted tile are spread at this many places in turn, because the sum of the last few is not yet ready to load.
constexpr int kStreams = 8;

template <int kCount>
struct States {
  Vecs<kCount> delay, rate, re, im;
};
template <int kCount>
struct Tones {
  Vecs<kCount> frequency, re, im;
};

// Computes the phase model of carrier.h, in half turns.
template <PhasorError kError, int kCount>
ECHOPATH_INLINE Tones<kCount> tones_of(const CarrierModel& model, const States<kCount>& states) {
  const double centre = 2.0 * model.centre_frequency, rest = 2.0 * model.centre_frequency_rest;
  const Vecs<kCount>& tau = states.delay;
  const Vecs<kCount> swept = tau * (model.slope * model.sample_interval);
  const Vecs<kCount> frequency = states.rate * (model.centre_frequency * model.sample_interval - swept) + swept;
  const Vecs<kCount> beside = tau * (rest - tau * model.slope) + frequency * (2.0 * model.reference_offset);
  const Vecs<kCount> turns = (tau * centre + beside) + kRoundingShift;
  const Vecs<kCount> left = exact_multiply_add(tau, centre, kRoundingShift - turns) + beside;
  const ComplexOf<Vecs<kCount>> phasor = phasor_of_half_turns<kError>(left);
  Tones<kCount> out;
#pragma GCC unroll 8
  for (int i = 0; i < kCount; ++i) {
    const Mask sign = bits(turns.of[i]) << 63;  // of an odd number of half turns
    const Vec c = from_bits(bits(phasor.re.of[i]) ^ sign), s = from_bits(bits(phasor.im.of[i]) ^ sign);
    const Vec f = frequency.of[i], re = states.re.of[i], im = states.im.of[i];
    const Mask kept = (f >= 0.0) & (f < model.highest_frequency);
    out.frequency.of[i] = kept ? f : Vec{};
    out.re.of[i] = kept ? re * c + im * s : Vec{};
    out.im.of[i] = kept ? re * s - im * c : Vec{};
  }
  return out;
}

void modulate(const CarrierModel& model, const EchoStates& states, int count, Carriers& out) {
  for (int p = 0; p < count; p += kLanes) {
    const Vec first = load(states.amplitude + 2 * p), second = load(states.amplitude + 2 * p + kLanes);
    const Vec re = every_other<0>(first, second), im = every_other<1>(first, second);
    const States<1> here{{load(states.delay + p)}, {load(states.rate + p)}, {re}, {im}};
    const Tones<1> tones = tones_of<PhasorError::kRounding>(model, here);
    store(out.frequency + p, tones.frequency.of[0]);
    store(out.re + p, tones.re.of[0]);
    store(out.im + p, tones.im.of[0]);
  }
}

// Holds the places of echoes on the grid at one chirp. Loops may read a vector beyond the last.
struct Places {
  static constexpr int kSize = TileAtChirps::kCapacity + 8;
  alignas(64) double t[kSize];  // place in the cell, [-1, 1]
  alignas(64) double re[kSize];
  alignas(64) double im[kSize];
  alignas(64) int32_t cell[kSize];  // of the first kernel value, counted from 1 - width
};

// Adding this to twice a place in cells, less 1, leaves twice the number of whole cells, which also stands in the lowest
// bits.
constexpr double kCellShift = 2.0 * kRoundingShift;

ECHOPATH_INLINE void locate(const Spreading& spreading, Vec frequency, int p, Places& places) {
  const Vec twice = multiply_add(frequency, all(2.0 * spreading.grid_size), all(spreading.width - 1.0));
  const Vec shifted = twice + kCellShift;
  store_lanes(places.cell + p, __builtin_convertvector(bits(shifted), Lanes<int32_t, kLanes>));
  store(places.t + p, (shifted - kCellShift) - twice);
}

// Marks where runs of one cell end: bit p of the words is set where the echo behind p has another cell or there is none.
struct RunEnds {
  static constexpr int kWords = TileAtChirps::kCapacity / 64;
  uint64_t word[kWords];

  RunEnds(const int32_t* cell, int count) {
    for (int w = 0; w < kWords; ++w) word[w] = 64 * w < count ? differences(cell + 64 * w, cell + 64 * w + 1) : 0;
    const int last = (count - 1) / 64;
    word[last] = (word[last] & ((uint64_t{1} << (count - 1) % 64) - 1)) | uint64_t{1} << (count - 1) % 64;
  }

  int count() const {
    int sum = 0;
    for (const uint64_t bits : word) sum += __builtin_popcountll(bits);
    return sum;
  }

  // Calls visit(begin, end) for each run.
  template <class Visit>
  ECHOPATH_INLINE void visit_runs(Visit visit) const {
    int begin = 0;
    for (int w = 0; w < kWords; ++w) {
      for (uint64_t bits = word[w]; bits != 0; bits &= bits - 1) {
        const int end = 64 * w + __builtin_ctzll(bits) + 1;
        visit(begin, end);
        begin = end;
      }
    }
  }
};

// Counts the echoes in each cell of a tile, for each of kCounters shares of the tile: a counter that was just raised is not
// yet ready to be raised again.
struct CellCounts {
  static constexpr int kCounters = 4;
  int share;  // echoes of each share but the last
  int32_t lowest;
  int num_cells;      // from the lowest to the highest; no counts where they are more than kCellsOfTile
  int num_taken = 0;  // that have echoes
  int32_t count[kCellsOfTile][kCounters];
};

// Calls visit(echo, share), with the shares in turn.
template <class Visit>
ECHOPATH_INLINE void visit_shares(int share, int count, Visit visit) {
  const int in_all = count - (CellCounts::kCounters - 1) * share;
  for (int p = 0; p < in_all; ++p) {
    for (int k = 0; k < CellCounts::kCounters; ++k) visit(k * share + p, k);
  }
  for (int k = 0; k < CellCounts::kCounters - 1; ++k) {
    for (int p = in_all > 0 ? in_all : 0; p < share && k * share + p < count; ++p) visit(k * share + p, k);
  }
}

// The first cells of the kernels of some echoes.
struct FirstCells {
  int32_t lowest, highest;
  int size() const { return highest - lowest + 1; }
};

FirstCells range_of(const int32_t* cell, int count) {
  FirstCells range{INT32_MAX, INT32_MIN};
  for (int p = 0; p < count; ++p) {
    range.lowest = cell[p] < range.lowest ? cell[p] : range.lowest;
    range.highest = cell[p] > range.highest ? cell[p] : range.highest;
  }
  return range;
}

CellCounts count_cells(const int32_t* cell, const FirstCells& range, int count) {
  const int32_t lowest = range.lowest;
  CellCounts counts;
  counts.share = (count + CellCounts::kCounters - 1) / CellCounts::kCounters;
  counts.lowest = lowest;
  counts.num_cells = range.size();
  if (counts.num_cells > kCellsOfTile) return counts;
  for (int c = 0; c < counts.num_cells; ++c) {
    for (int k = 0; k < CellCounts::kCounters; ++k) counts.count[c][k] = 0;
  }
  visit_shares(counts.share, count,
               [&](int p, int k) __attribute__((always_inline)) { ++counts.count[cell[p] - lowest][k]; });
  for (int c = 0; c < counts.num_cells; ++c) {
    int32_t sum = 0;
    for (int k = 0; k < CellCounts::kCounters; ++k) sum += counts.count[c][k];
    counts.num_taken += sum != 0 ? 1 : 0;
  }
  return counts;
}

// Sorts the echoes by cell; those of one cell keep their order. `counts` then tells where the echoes of each share and cell
// end.
void bring_together(const Places& places, int count, CellCounts& counts, Places& sorted) {
  int32_t sum = 0;
  for (int c = 0; c < counts.num_cells; ++c) {
    for (int k = 0; k < CellCounts::kCounters; ++k) {
      const int32_t here = counts.count[c][k];
      counts.count[c][k] = sum;
      sum += here;
    }
  }
  visit_shares(counts.share, count, [&](int p, int k) __attribute__((always_inline)) {
    const int32_t to = counts.count[places.cell[p] - counts.lowest][k]++;
    sorted.t[to] = places.t[p];
    sorted.re[to] = places.re[p];
    sorted.im[to] = places.im[p];
  });
}

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
    const Vec t = all(places.t[p]);
    Vec re[kVectors], im[kVectors];
#pragma GCC unroll 8
    for (int v = 0; v < kVectors; ++v) {
      Vec value = load(coefficients + v * kLanes);
#pragma GCC unroll 16
      for (int d = 1; d < kTerms; ++d) value = multiply_add(value, t, load(coefficients + d * kPadded + v * kLanes));
      re[v] = value * places.re[p];
      im[v] = value * places.im[p];
    }
    add_window(re, im, first + places.cell[p]);
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
      // Even moments take the amplitude times powers of t^2, odd ones the amplitude times t likewise.
      const Vec square = t * t, re_t = re * t, im_t = im * t;
      Vec power = all(1.0);
#pragma GCC unroll 16
      for (int d = 0; d + 1 < kFirst; d += 2) power = power * square;
#pragma GCC unroll 16
      for (int d = 0; d < kCount; ++d) {
        const bool is_odd = (kFirst + d) % 2 != 0;
        moment_re[d] = multiply_add(power, is_odd ? re_t : re, moment_re[d]);
        moment_im[d] = multiply_add(power, is_odd ? im_t : im, moment_im[d]);
        if (is_odd) power = power * square;
      }
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
#pragma GCC unroll 16
    for (int d = 0; d < kTerms; ++d) {
#pragma GCC unroll 8
      for (int v = 0; v < kVectors; ++v) {
        const Vec coefficient = load(coefficients + (kTerms - 1 - d) * kPadded + v * kLanes);
        re[v] = multiply_add(coefficient, all(moments.re[d]), re[v]);
        im[v] = multiply_add(coefficient, all(moments.im[d]), im[v]);
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

template <int kChirps>
ECHOPATH_INLINE void store_places(const Spreading& spreading, const Tones<kChirps>& tones, int p, Places* places) {
#pragma GCC unroll 4
  for (int c = 0; c < kChirps; ++c) {
    locate(spreading, tones.frequency.of[c], p, places[c]);
    store(places[c].re + p, tones.re.of[c]);
    store(places[c].im + p, tones.im.of[c]);
  }
}

// Finds the places of a tile at kChirps chirps from `chirp` on, which interpolate between the same nodes.
template <PhasorError kError, int kChirps>
ECHOPATH_INLINE void place_tile(const CarrierModel& model, const Spreading& spreading, const TileAtChirps& tile, int chirp,
                                Places* places) {
  constexpr int kRow = 3 * TileAtChirps::kLanes;  // doubles of one node
  const double* value = tile.value + chirp * tile.order;
  const double* slope = tile.slope + chirp * tile.order;
  for (int p = 0; p < tile.count; p += kLanes) {
    const int vector = p / TileAtChirps::kLanes;
    const double* node =
        tile.nodes + (int64_t{vector} * tile.num_nodes + tile.first_row[chirp]) * kRow + p % TileAtChirps::kLanes;
    States<kChirps> states = {};
    for (int k = 0; k < tile.order; ++k, node += kRow) {
      const Vec d = load(node), r = load(node + TileAtChirps::kLanes), i = load(node + 2 * TileAtChirps::kLanes);
#pragma GCC unroll 4
      for (int c = 0; c < kChirps; ++c) {
        const Vec weight = all(value[c * tile.order + k]);
        states.delay.of[c] = multiply_add(weight, d, states.delay.of[c]);
        states.rate.of[c] = multiply_add(all(slope[c * tile.order + k]), d, states.rate.of[c]);
        states.re.of[c] = multiply_add(weight, r, states.re.of[c]);
        states.im.of[c] = multiply_add(weight, i, states.im.of[c]);
      }
    }
    store_places(spreading, tones_of<kError>(model, states), p, places);
  }
}

bool same_nodes(const TileAtChirps& tile, int chirp, int count) {
  for (int c = 1; c < count; ++c) {
    if (tile.first_row[chirp + c] != tile.first_row[chirp]) return false;
  }
  return true;
}

template <PhasorError kError>
void place_tile_at_all(const CarrierModel& model, const Spreading& spreading, const TileAtChirps& tile, Places* places) {
  for (int chirp = 0; chirp < tile.num_chirps;) {
    if (chirp + kChirpsAtOnce <= tile.num_chirps && same_nodes(tile, chirp, kChirpsAtOnce)) {
      place_tile<kError, kChirpsAtOnce>(model, spreading, tile, chirp, places + chirp);
      chirp += kChirpsAtOnce;
    } else {
      place_tile<kError, 1>(model, spreading, tile, chirp, places + chirp);
      ++chirp;
    }
  }
}

// Returns where the kernels of a tile begin at all its chirps.
FirstCells range_of(const Places* places, const TileAtChirps& tile) {
  FirstCells all{INT32_MAX, INT32_MIN};
  for (int chirp = 0; chirp < tile.num_chirps; ++chirp) {
    const FirstCells here = range_of(places[chirp].cell, tile.count);
    all.lowest = here.lowest < all.lowest ? here.lowest : all.lowest;
    all.highest = here.highest > all.highest ? here.highest : all.highest;
  }
  return all;
}

void add_tile(const CarrierModel& model, const Spreading& spreading, const TileAtChirps& tile, const RowRoom& room) {
  Places places[TileAtChirps::kMaxChirps];
  // These phasor errors are far below the error of the kernel, which is 1e-7 and 9e-4 at these widths.
  if (spreading.width <= 4) place_tile_at_all<PhasorError::k7em6>(model, spreading, tile, places);
  else if (spreading.width <= 8) place_tile_at_all<PhasorError::k1em12>(model, spreading, tile, places);
  else place_tile_at_all<PhasorError::kRounding>(model, spreading, tile, places);
  const FirstCells cells = range_of(places, tile);
  const TileRows rows = room.rows_for(room.of, {cells.lowest, cells.highest + NufftKernel::padded(spreading.width)});
  const Spreading there{spreading.width, spreading.coefficients, spreading.grid_size, rows.row_length};
  for (int chirp = 0; chirp < tile.num_chirps; ++chirp) {
    kSpreadTile[spreading.width - NufftKernel::kMinWidth](there, places[chirp], tile.count,
                                                          rows.rows + chirp * rows.chirp_stride);
  }
}

constexpr SignalKernels kSignalKernels = {modulate, spread, add_tile};

}  // namespace
}  // namespace echopath::ECHOPATH_KERNELS

namespace echopath {

template <>
const SignalKernels& kernels_for<SignalKernels, ECHOPATH_KERNELS::kInstructionSet>() {
  return ECHOPATH_KERNELS::kSignalKernels;
}

}  // namespace echopath
