#pragma once
// Holds the inner loops of replay over paths of one point each, side by side in vectors, compiled once for each instruction
// set from single_bounce_kernels_body.h (see shared_leg_kernels.h).
#include <cstddef>

#include "echopath/replay/kernels/cell_formula.h"

namespace echopath {

// Holds points of one mesh that both antennas see, each with a coherent and a diffuse path back. The mesh is rigid: seen
// from it, the antennas move, and its points stay where they were at the trace.
struct SingleBounceSlots {
  static constexpr size_t kSlots = 8;  // whatever the instruction set
  enum Kind { kCoherent, kDiffuse, kNumKinds };
  typedef double Row[kSlots];

  // The caller gives the triangle in the mesh's frame, in m, and where the point is in it; the rays per sr of the launch
  // cell's stratum, 0 where there is no cell; and the weights with all that does not change, re and im.
  alignas(64) Row corner[3];
  alignas(64) Row edge[2][3];
  alignas(64) Row along_edge[2];
  alignas(64) Row density;
  alignas(64) Row weight[kNumKinds][2];
  alignas(64) Row matrix[kNumKinds][4][2];  // where polarised, the weights times the path's JonesMatrix

  // The kernel `prepare` finds, at the trace: point (m); normal (unit); tangents of the launch cell (m) and their products
  // (m^2); and has_cell (1 or 0).
  alignas(64) Row point[3];
  alignas(64) Row normal[3];
  alignas(64) Row tangent[2][3];
  alignas(64) Row product[3];
  alignas(64) Row has_cell;
};

// Describes a mesh at the trace, relative to the mean transmitter; matrices stand row by row.
struct SingleBounceTrace {
  double linear[9], translation[3];
  double normal[9];           // of normals, not normalised
  double mesh_from_trace[9];  // undoes `linear`
};

// Describes the motion of an antenna about the mesh, as if the mesh stayed where it was at the trace.
struct AntennaToSee {
  const double* mesh;     // PointToPose::MeshRow
  const double* antenna;  // LegToMeasure::ImageRow, in the world
  double* out;            // LegToMeasure::ImageRow, about the mesh
};

struct SingleBounceAntenna {
  const double* rows;          // AntennaToSee::out, rows of `stride` nodes
  const double* polarization;  // ComponentsToFind::PolarizationRow, rows of `stride` nodes
  int exponent;                // LegToMeasure::exponent, a whole one
  double root_peak;
};

struct SingleBouncesToEvaluate {
  static constexpr size_t kNodesTogether = 8;
  enum LegRow { kLegLength, kInverse, kLegFactor, kGain, kCosine, kAlong, kHorizontal = 7, kVertical, kNumLegRows };
  enum Row { kLength, kRe, kIm = 2, kNumRows = 5 };  // m, sqrt(W); re and im of both kinds, one after the other

  const SingleBounceSlots* slots;
  bool has_coherent;  // whether any slot has a coherent path; else its rows are 0
  const SingleBounceAntenna* antennas[2];
  size_t num_antennas[2];
  bool is_monostatic;                  // both ends have the same antennas, hence the same legs
  size_t first_channel, num_channels;  // [tx * num_rx + rx]
  size_t num_nodes, stride;
  CellFilter filter;
  double facet_area;            // m^2, of the mesh in hand (PathPreparer::facet_area)
  const double* axes;           // polarised: of the world as seen from the mesh (ComponentsToFind::AxisRow); else null
  double traced_antenna[2][3];  // m, mean transmitter and mean receiver at the trace
  double* legs;                 // room for [kNodesTogether, end, antenna, kNumLegRows, slot]
  double* out;                  // [channel, node, kNumRows, slot]
  double* turned;               // [slot] 1 where the point turns its other side to the first antenna of an end on the way
  double mirror_scale;          // RadioConstants::mirror_scale
  double* unfiltered;  // [slot] SingleBounceEvaluation::Wanted::unfiltered, between the first antennas at the first node
};

struct SingleBounceKernels {
  void (*see)(const SingleBounceTrace& trace, const AntennaToSee& antenna, size_t stride);
  void (*prepare)(const SingleBounceTrace& trace, SingleBounceSlots& slots);
  void (*evaluate)(const SingleBouncesToEvaluate& paths);
};

// Returns the kernels for rows of `stride` nodes, for the best instruction set of this machine.
const SingleBounceKernels& single_bounce_kernels(size_t stride);

}  // namespace echopath
