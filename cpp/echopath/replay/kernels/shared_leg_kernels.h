#pragma once
// Holds the inner loops of replay along nodes, compiled once for each instruction set from shared_leg_kernels_body.h. The
// headers that this one includes define no functions with code: what is compiled for one instruction set must not be linked
// into another's.
//
// Pointers to constant or written doubles are the first of several rows of `stride` nodes each (node_rows.h).
#include <cstddef>

#include "echopath/base/lanes/scalar_math.h"
#include "echopath/em/polarization/transverse_formula.h"
#include "echopath/replay/kernels/cell_formula.h"

namespace echopath {

// Describes a point and its normal that move with a mesh.
struct PointToPose {
  enum MeshRow { kLinear, kTranslation = 9, kNumMeshRows = 12 };  // world from mesh: matrix row by row; m
  enum Row { kPosition, kNormal = 3, kAreaRatio = 6, kNumRows };
  const double* mesh;
  double position[3], normal[3];  // in the mesh's frame: m; unit behind the matrix
  double* out;                    // area ratio 1
};

// Describes a leg from the image of an antenna to a point.
struct LegToMeasure {
  enum ImageRow { kImagePosition, kBoresight = 3, kNumImageRows = 6 };  // m; unit
  // The rows hold the length in m, the diffuse_leg (path_formula.h) and the root of the gain.
  enum Row { kLength, kFactor, kGain, kNumRows };
  static constexpr int kNoExponent = -1;
  const double *image, *point;
  // The gain is root_peak^2 cos^exponent in front of the antenna. With kNoExponent the cosine of the boresight takes the
  // place of the gain, and the cosine at the point that of the factor.
  int exponent;
  double root_peak;
  double* out;
};

// Describes the part between the first and the last material point (DiffuseInner, InnerPart::last_arrival).
struct InnerRows {
  enum Row { kLength, kToFirst, kRootCosFirst, kFactor, kFirstSign, kLastSign, kArrival, kNumRows = 9 };
};

// Describes a path of two legs and the part between them.
struct PathToCombine {
  enum Row { kLength, kRe, kIm, kTurn, kNumRows };  // m, sqrt(W), rad
  const double *start, *end;
  const double* inner;       // null: one material point
  ComplexOf<double> weight;  // with all that does not change
  double* out;
};

struct DiffusePath {
  PathToCombine path;
  bool begins_specular, is_single;  // of `inner`
};

// Describes a path with physical optics at the last material point.
struct CoherentPath {
  PathToCombine path;
  const double *start_image, *end_image, *point;
  const double* mesh;    // in whose frame the tangents are
  double tangent[2][3];  // T_a, m
  CellShape cell;
  CellFilter filter;
  double root_area;  // of curved cells, sqrt(|T_1 x T_2| density), m sr^-1/2
};

// Asks how large the amplitude of a coherent path can be between any antennas that stand so far (m, at most) from those at
// the two ends of `path`.
struct AmplitudeToBound {
  // The rows hold the largest logarithm of the filter and least_spreading (path_formula.h). A spreading that is not positive
  // tells that there is no bound.
  enum Row { kFilter, kSpreading, kNumRows };
  const CoherentPath& path;
  double around_start, around_end;
  double* out;
};

// Describes the polarisation of an antenna across a leg, as the wave departs: its horizontal and vertical components at the
// antenna (transverse_of). For a wave that arrives over the same leg the horizontal component changes its sign.
struct ComponentsToFind {
  enum AxisRow { kAxes, kNumAxisRows = 9 };  // of the world as they look over the mirrors of the image, one by one; unit
  enum PolarizationRow { kNumPolarizationRows = 3 };  // of the antenna, in the world
  enum Row { kHorizontal, kVertical, kNumRows };
  const double *image, *axes, *polarization, *point;
  AxesAcross<double> recorded;  // at the antenna: those of the matrix of the path
  double* out;
};

// Describes a path that is combined, with the polarisations of both ends.
struct PathToPolarize {
  const double *start, *end;  // ComponentsToFind::Row
  double re[4], im[4];        // JonesMatrix
  double* out;                // PathToCombine::Row
};

struct SharedLegKernels {
  void (*pose)(const PointToPose& point, size_t stride);
  void (*measure)(const LegToMeasure& leg, size_t stride);
  void (*combine)(const DiffusePath& path, size_t stride);
  void (*connect)(const PathToCombine& path, size_t stride);                           // over flagged mirrors alone
  void (*reflect)(const CoherentPath& path, size_t begin, size_t end, size_t stride);  // nodes [begin, end)
  // Leaves the turn of the launch cell's filter (TurnApart) out of the amplitude and writes it beside.
  void (*reflect_with_turn_apart)(const CoherentPath& path, size_t begin, size_t end, size_t stride);
  void (*bound)(const AmplitudeToBound& work, size_t stride);
  void (*find_components)(const ComponentsToFind& leg, size_t stride);
  void (*polarize)(const PathToPolarize& path, size_t stride);
};

// Holds two forms of the same kernels: `of_many` takes several nodes of a row side by side in a vector, and `of_one` takes
// one node after the other. The second serves rows of a single node, for which vectors would be nearly empty.
template <class Kernels>
struct ForRows {
  Kernels of_many, of_one;
};

// Returns the kernels for rows of `stride` nodes, for the best instruction set of this machine.
const SharedLegKernels& shared_leg_kernels(size_t stride);
// Returns the kernels that take one node after the other.
const SharedLegKernels& shared_leg_kernels_of_one();

}  // namespace echopath
