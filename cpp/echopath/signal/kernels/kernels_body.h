#pragma once
// Holds the inner loops of synthesis, compiled once per instruction set (base/lanes/lane_math.h).
#include "echopath/signal/kernels/chirps_body.h"
#include "echopath/signal/kernels/spreader_body.h"
#include "echopath/signal/kernels/tones_body.h"

namespace echopath::ECHOPATH_KERNELS {
namespace {

// With this many chirps, the echoes of a vector of nodes fit into the registers.
constexpr int kChirpsAtOnce = kLanes == 8 ? 4 : 2;

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
    if (tile.has_logarithms) undo_logarithms(model, states);
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

// Adds a tile to the rows of some chirps, whose echoes take other nodes at each.
template <PhasorError kError>
void add_echo_lanes(const CarrierModel& model, const Spreading& spreading, const TileAtChirps& tile, const RowRoom& room) {
  Places places[TileAtChirps::kMaxChirps];
  place_tile_at_all<kError>(model, spreading, tile, places);
  const FirstCells cells = range_of(places, tile);
  const TileRows rows = room.rows_for(room.of, {cells.lowest, cells.highest + NufftKernel::padded(spreading.width)});
  const Spreading there{spreading.width, spreading.coefficients, spreading.grid_size, rows.row_length};
  for (int chirp = 0; chirp < tile.num_chirps; ++chirp) {
    kSpreadTile[spreading.width - NufftKernel::kMinWidth](there, places[chirp], tile.count,
                                                          rows.rows + chirp * rows.chirp_stride);
  }
}

// Adds a tile whose echoes take the same nodes at all chirps.
template <PhasorError kError>
void add_chirp_lanes(const CarrierModel& model, const Spreading& spreading, const TileAtChirps& tile, const RowRoom& room) {
  for (int first = 0; first < tile.num_chirps; first += kLanes) {
    ChirpPlaces places;
    place_at_chirps<kError>(model, spreading, tile, first, places);
    TileRows rows =
        room.rows_for(room.of, {places.range.lowest, places.range.highest + NufftKernel::padded(spreading.width)});
    rows.rows += first * rows.chirp_stride;
    const int num_chirps = tile.num_chirps - first < kLanes ? tile.num_chirps - first : kLanes;
    kSpreadChirps[spreading.width - NufftKernel::kMinWidth](spreading, places, tile.count, num_chirps, rows);
  }
}

template <PhasorError kError>
void add_tile_to(const CarrierModel& model, const Spreading& spreading, const TileAtChirps& tile, const RowRoom& room) {
  const bool fills_lanes = 2 * tile.num_chirps > kLanes && tile.order <= ChirpWeights::kMaxOrder;
  const auto add = fills_lanes && same_nodes(tile, 0, tile.num_chirps) ? add_chirp_lanes<kError> : add_echo_lanes<kError>;
  add(model, spreading, tile, room);
}

void add_tile(const CarrierModel& model, const Spreading& spreading, const TileAtChirps& tile, const RowRoom& room) {
  // These phasor errors are far below the error of the kernel, which is 9e-4 and 1e-7 at these widths.
  if (spreading.width <= 4) add_tile_to<PhasorError::k7em6>(model, spreading, tile, room);
  else if (spreading.width <= 8) add_tile_to<PhasorError::k1em12>(model, spreading, tile, room);
  else add_tile_to<PhasorError::kRounding>(model, spreading, tile, room);
}

constexpr SignalKernels kSignalKernels = {undo_logarithms, modulate, spread, add_tile};

}  // namespace
}  // namespace echopath::ECHOPATH_KERNELS

namespace echopath {

template <>
const SignalKernels& kernels_for<SignalKernels, ECHOPATH_KERNELS::kInstructionSet>() {
  return ECHOPATH_KERNELS::kSignalKernels;
}

}  // namespace echopath
