#pragma once
// Adds a tile to the rows of neighbouring chirps, one chirp in each lane: an echo stays in its cell from one chirp to the
// next, so that the moments of a cell grow in all chirps at once, and no sum runs across lanes.
#include "echopath/signal/kernels/spreader_body.h"
#include "echopath/signal/kernels/tones_body.h"

namespace echopath::ECHOPATH_KERNELS {
namespace {

// Holds the places of echoes on the grid at kLanes chirps, [echo, chirp].
struct ChirpPlaces {
  static constexpr int kSize = TileAtChirps::kCapacity * kLanes;
  alignas(64) double t[kSize];  // place in the cell, [-1, 1]
  alignas(64) double re[kSize];
  alignas(64) double im[kSize];
  alignas(64) int32_t cell[kSize];  // of the first kernel value, counted from 1 - width
  // [echo] the cell where it stays, or kMoves; loops may read a vector beyond the last.
  static constexpr int32_t kMoves = INT32_MAX;
  alignas(64) int32_t home[TileAtChirps::kCapacity + 8];
  FirstCells range;
};

// From this many echoes in one cell on, their moments are quicker than a kernel for each.
constexpr int kFewAtChirps = 3;

// Lists the echoes that stay in one cell, cell by cell, and then those that move to another.
struct EchoesByCell {
  static constexpr int kMaxCells = 256;
  int num_cells, end[kMaxCells + 1];  // [cell from the lowest on], the last one for echoes that move
  int16_t echo[TileAtChirps::kCapacity];

  // The range must be no more than kMaxCells. Most neighbours share a cell.
  EchoesByCell(const ChirpPlaces& places, int count) : num_cells(places.range.size()) {
    const RunEnds runs(places.home, count);
    const auto list_of = [&](int p) __attribute__((always_inline)) {
      return places.home[p] == ChirpPlaces::kMoves ? num_cells : places.home[p] - places.range.lowest;
    };
    for (int c = 0; c <= num_cells; ++c) end[c] = 0;
    runs.visit_runs([&](int from, int to) __attribute__((always_inline)) { end[list_of(from)] += to - from; });
    int sum = 0;
    for (int c = 0; c <= num_cells; ++c) {
      const int here = end[c];
      end[c] = sum;
      sum += here;
    }
    runs.visit_runs([&](int from, int to) __attribute__((always_inline)) {
      int& place = end[list_of(from)];
      for (int p = from; p < to; ++p) echo[place++] = static_cast<int16_t>(p);
    });
  }
};

template <int kWidth>
struct ChirpSpreader {
  static constexpr int kTerms = Spreader<kWidth>::kTerms, kVectors = Spreader<kWidth>::kVectors;
  const Spreader<kWidth> spreader;
  const ChirpPlaces& places;
  const int num_chirps;
  double* const rows;  // of the first chirp
  const int64_t chirp_stride;

  // Holds the sums over echoes of one cell of (re, im) t^d, d < kTerms, at each chirp.
  struct Moments {
    alignas(64) double re[kTerms * kLanes], im[kTerms * kLanes];
  };

  // Finds terms [kFirst, kFirst + kCount).
  template <int kFirst, int kCount>
  ECHOPATH_INLINE void find_terms(const int16_t* echo, int count, Moments& out) const {
    Vec sum_re[kCount] = {}, sum_im[kCount] = {};
    for (int i = 0; i < count; ++i) {
      const int at = echo[i] * kLanes;
      Spreader<kWidth>::template add_powers<kFirst, kCount>(load(places.t + at), load(places.re + at), load(places.im + at),
                                                            sum_re, sum_im);
    }
#pragma GCC unroll 16
    for (int d = 0; d < kCount; ++d) {
      store(out.re + (kFirst + d) * kLanes, sum_re[d]);
      store(out.im + (kFirst + d) * kLanes, sum_im[d]);
    }
    if constexpr (kFirst + kCount < kTerms) {
      constexpr int kNext = kFirst + kCount, kLeft = kTerms - kNext;
      find_terms<kNext, (kLeft < kTermsAtOnce ? kLeft : kTermsAtOnce)>(echo, count, out);
    }
  }

  ECHOPATH_INLINE void add_cell(int32_t cell, const int16_t* echo, int count) const {
    Moments moments;
    find_terms<0, (kTerms < kTermsAtOnce ? kTerms : kTermsAtOnce)>(echo, count, moments);
    for (int chirp = 0; chirp < num_chirps; ++chirp) {
      Vec re[kVectors] = {}, im[kVectors] = {};
      spreader.template add_kernels_of<kLanes>(moments.re + chirp, moments.im + chirp, re, im);
      spreader.add_window(re, im, rows + chirp * chirp_stride + cell);
    }
  }

  // Adds an echo by itself.
  ECHOPATH_INLINE void add_echo(int p) const {
    for (int chirp = 0; chirp < num_chirps; ++chirp) {
      const int at = p * kLanes + chirp;
      spreader.add_at(places.t[at], places.re[at], places.im[at], rows + chirp * chirp_stride + places.cell[at]);
    }
  }

  void add(const EchoesByCell& by_cell) const {
    int begin = 0;
    for (int c = 0; c <= by_cell.num_cells; ++c) {
      const int end = by_cell.end[c];
      if (c < by_cell.num_cells && end - begin >= kFewAtChirps) {
        add_cell(places.range.lowest + c, by_cell.echo + begin, end - begin);
      } else {
        for (int i = begin; i < end; ++i) add_echo(by_cell.echo[i]);
      }
      begin = end;
    }
  }
};

template <int kWidth>
void spread_chirps(const Spreading& spreading, const ChirpPlaces& places, int count, int num_chirps, const TileRows& rows) {
  const ChirpSpreader<kWidth> spreader{
      {spreading.coefficients, rows.row_length}, places, num_chirps, rows.rows, rows.chirp_stride};
  if (places.range.size() <= EchoesByCell::kMaxCells) return spreader.add(EchoesByCell(places, count));
  for (int p = 0; p < count; ++p) spreader.add_echo(p);
}

using SpreadChirps = void (*)(const Spreading&, const ChirpPlaces&, int, int, const TileRows&);
constexpr SpreadChirps kSpreadChirps[] = {spread_chirps<3>,  spread_chirps<4>,  spread_chirps<5>,  spread_chirps<6>,
                                          spread_chirps<7>,  spread_chirps<8>,  spread_chirps<9>,  spread_chirps<10>,
                                          spread_chirps<11>, spread_chirps<12>, spread_chirps<13>, spread_chirps<14>,
                                          spread_chirps<15>, spread_chirps<16>};

// Holds the weights of kLanes chirps, [order, chirp].
struct ChirpWeights {
  static constexpr int kMaxOrder = 64;
  alignas(64) double value[kMaxOrder * kLanes];
  alignas(64) double slope[kMaxOrder * kLanes];

  ChirpWeights(const TileAtChirps& tile, int first) {
    for (int k = 0; k < tile.order; ++k) {
      for (int c = 0; c < kLanes; ++c) {
        const int chirp = first + c < tile.num_chirps ? first + c : tile.num_chirps - 1;
        value[k * kLanes + c] = tile.value[chirp * tile.order + k];
        slope[k * kLanes + c] = tile.slope[chirp * tile.order + k];
      }
    }
  }
};

constexpr int kEchoesAtOnce = kLanes == 8 ? 4 : 2;  // whose steps are taken together

template <PhasorError kError>
void place_at_chirps(const CarrierModel& model, const Spreading& spreading, const TileAtChirps& tile, int first,
                     ChirpPlaces& places) {
  constexpr int kRow = 3 * TileAtChirps::kLanes;  // doubles of one node
  const ChirpWeights weights(tile, first);
  Vec lowest = all(1e18), highest = all(-1e18);
  // The layout has whole vectors of echoes, of which the last few may have no amplitude.
  for (int p = 0; p < tile.count; p += kEchoesAtOnce) {
    const int64_t vector = p / TileAtChirps::kLanes;
    const double* node = tile.nodes + (vector * tile.num_nodes + tile.first_row[first]) * kRow + p % TileAtChirps::kLanes;
    States<kEchoesAtOnce> states = {};
    for (int k = 0; k < tile.order; ++k, node += kRow) {
      const Vec value = load(weights.value + k * kLanes), slope = load(weights.slope + k * kLanes);
#pragma GCC unroll 4
      for (int e = 0; e < kEchoesAtOnce; ++e) {
        const Vec delay = all(node[e]);
        states.delay.of[e] = multiply_add(value, delay, states.delay.of[e]);
        states.rate.of[e] = multiply_add(slope, delay, states.rate.of[e]);
        states.re.of[e] = multiply_add(value, all(node[e + TileAtChirps::kLanes]), states.re.of[e]);
        states.im.of[e] = multiply_add(value, all(node[e + 2 * TileAtChirps::kLanes]), states.im.of[e]);
      }
    }
    if (tile.has_logarithms) undo_logarithms(model, states);
    const Tones<kEchoesAtOnce> tones = tones_of<kError>(model, states);
#pragma GCC unroll 4
    for (int e = 0; e < kEchoesAtOnce; ++e) {
      if (p + e >= tile.count) break;
      const Located found = located(spreading, tones.frequency.of[e]);
      const int at = (p + e) * kLanes;
      store(places.t + at, found.t);
      store(places.re + at, tones.re.of[e]);
      store(places.im + at, tones.im.of[e]);
      store_lanes(places.cell + at, __builtin_convertvector(bits(found.shifted), Lanes<int32_t, kLanes>));
      lowest = LaneMath::smaller(lowest, found.shifted);
      highest = LaneMath::larger(highest, found.shifted);
      const bool moves = LaneMath::any(found.shifted != all(found.shifted[0]));
      places.home[p + e] = moves ? ChirpPlaces::kMoves : places.cell[at];
    }
  }
  places.range = {INT32_MAX, INT32_MIN};
  const auto low = __builtin_convertvector(bits(lowest), Lanes<int32_t, kLanes>),
             high = __builtin_convertvector(bits(highest), Lanes<int32_t, kLanes>);
  for (int c = 0; c < kLanes; ++c) {
    places.range.lowest = low[c] < places.range.lowest ? low[c] : places.range.lowest;
    places.range.highest = high[c] > places.range.highest ? high[c] : places.range.highest;
  }
}

}  // namespace
}  // namespace echopath::ECHOPATH_KERNELS
