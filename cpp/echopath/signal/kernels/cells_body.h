#pragma once
// Finds the places of echoes on the grid of frequencies, and their order by cells of that grid.
#include "echopath/base/lanes/lane_math.h"
#include "echopath/base/lanes/vecs.h"
#include "echopath/signal/kernels/kernels.h"

namespace echopath::ECHOPATH_KERNELS {
namespace {

// A tile's echoes are counted by cell where they lie in so many cells or fewer.
constexpr int kCellsOfTile = 128;

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

// Holds the cell, in the lowest bits of `shifted`, and the place in it, [-1, 1].
struct Located {
  Vec shifted, t;
};
ECHOPATH_INLINE Located located(const Spreading& spreading, Vec frequency) {
  const Vec twice = multiply_add(frequency, all(2.0 * spreading.grid_size), all(spreading.width - 1.0));
  const Vec shifted = twice + kCellShift;
  return {shifted, (shifted - kCellShift) - twice};
}
ECHOPATH_INLINE void locate(const Spreading& spreading, Vec frequency, int p, Places& places) {
  const Located found = located(spreading, frequency);
  store_lanes(places.cell + p, __builtin_convertvector(bits(found.shifted), Lanes<int32_t, kLanes>));
  store(places.t + p, found.t);
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

// Holds the first cells of the kernels of some echoes.
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

}  // namespace
}  // namespace echopath::ECHOPATH_KERNELS
