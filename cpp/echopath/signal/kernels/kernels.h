#pragma once
// Holds the inner loops of synthesis, compiled once for each instruction set from kernels_body.h. The headers that this one
// includes define no functions with code: what is compiled for one instruction set must not be linked into another's.
#include <cstdint>

#include "echopath/base/lanes/simd.h"
#include "echopath/signal/kernels/carrier.h"

namespace echopath {

// Holds the rows of all groups at one chirp and channel: the real parts of group g begin at of_group[g] + first, the
// imaginary parts a row length later. Rows are zero before the first echo; groups without echoes need none.
struct Rows {
  double* const* of_group;
  int64_t first;
};

// Describes the kernel of a NUFFT and the grid on which it is spread.
struct Spreading {
  int width;
  const double* coefficients;  // NufftKernel::coefficients
  double grid_size;            // M
  int64_t row_length;
};

// Names the cells [first, end) of a row.
struct CellRange {
  int64_t first, end;
};

// Says where rows of some chirps stand: cell c of the first chirp has its real part at rows + c, its imaginary part
// `row_length` behind that, and the next chirp begins `chirp_stride` behind.
struct TileRows {
  double* rows;
  int64_t row_length, chirp_stride;
};

// Gives rows that have room for some cells.
struct RowRoom {
  TileRows (*rows_for)(void* of, const CellRange& cells);
  void* of;
};

// Holds echoes of one group, near each other in delay, in the layout of EchoTiles, at a few chirps.
struct TileAtChirps {
  static constexpr int kLanes = 8;       // of the layout, whatever the instruction set
  static constexpr int kCapacity = 256;  // echoes: carriers of kMaxChirps chirps stay in the second-level cache
  static constexpr int kMaxChirps = 8;   // for which the nodes are read once
  const double* nodes;                   // [vectors of kLanes echoes, num_nodes, (delay, re, im), kLanes]
  int count;                             // echoes; the last vector is filled up with echoes of amplitude 0
  int num_nodes, order;
  int num_chirps;        // 1 to kMaxChirps
  const int* first_row;  // [num_chirps], as in TimeSampling
  const double* value;   // [num_chirps, order]
  const double* slope;   // [num_chirps, order]
  bool has_logarithms;   // TimeSampling::Rows::kLogarithms
};

struct SignalKernels {
  // Turns (natural logarithm of the size, phase in rad) [count] into (re, im) in place (TimeSampling::Rows::kLogarithms).
  // The array has room for a whole number of vectors of TileAtChirps::kLanes.
  void (*undo_logarithms)(double* amplitude, int count);
  // Computes the carriers of the states.
  void (*modulate)(const CarrierModel& model, const EchoStates& states, int count, Carriers& out);
  // Adds carriers in any order, each to the row of its group.
  void (*spread)(const Spreading& spreading, const Carriers& carriers, Rows rows);
  // Adds a tile to one row per chirp.
  void (*add_tile)(const CarrierModel& model, const Spreading& spreading, const TileAtChirps& tile, const RowRoom& room);
};

// Returns those of the instruction set picked.
const SignalKernels& signal_kernels();

}  // namespace echopath
