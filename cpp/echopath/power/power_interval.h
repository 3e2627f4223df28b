#pragma once
// Computes the 95 % interval of a received power from what the launch cells take away and what chance adds.
#include <complex>
#include <cstdint>
#include <limits>
#include <vector>

#include "echopath/replay/kernels/cell_formula.h"

namespace echopath {

// Launch cells are viewed as launched, a little finer, as those of half as many rays, without a filter, and by the waves of
// points and of edges that they may hold between rays.
inline constexpr CellView kCellViews[] = {
    {1.0}, {0.8}, {1.4142135623730951}, {0.0}, {1.0, CellWeight::kPoints}, {1.0, CellWeight::kEdges}};
enum CellViewIndex { kAsLaunched, kFiner, kHalfDensity, kUnfiltered, kPoints, kEdges, kNumCellViews };

// Sums up the coherent paths of one kind. Paths that radiate from one mesh are two kinds: the wave has come straight or over
// flagged mirrors, or it has bounced off other surfaces before. Paths over flagged mirrors alone are another kind. What is
// known of one kind tells nothing of another, so that the interval of a body depends a little on the meshes that it is made
// of.
struct CoherentKind {
  uint64_t id = 0;                            // which one, of its set of paths
  std::complex<double> field[kNumCellViews];  // sqrt(W)
  double power[kNumCellViews] = {};           // W, sum of |a|^2
  double edge_squares = 0.0;                  // W^2, sum of |a|^4 of kEdges
  // W, the part of power[kEdges] that is of cells at the rim of what they see (outline.h); infinite: nobody looked.
  double edges_at_rim = std::numeric_limits<double>::infinity();

  // Whether what its cells may hold between rays is of interest.
  bool is_uncertain() const;
};

// Holds what the record tells of the power of a set of paths, with all rays.
struct PowerEvidence {
  double coherent = 0.0, diffuse = 0.0;  // W, the estimates
  std::vector<CoherentKind> kinds;
  // Sums over the coherent paths that hardly change at half the density, such as those of flat surfaces up to their edges:
  // of |a|^2, W, and of its squares, W^2.
  double steady_power = 0.0, steady_squares = 0.0;
  double lattice_squares = 0.0;  // W^2, sum of squares of the powers of diffuse hits that the launch lattice found
  double drawn_squares = 0.0;    // W^2, of those that were found by directions drawn at random
  int num_batches = 1;
  double standard_error = 0.0;  // W, of coherent + diffuse by the batches; not used for one
};

struct PowerInterval {
  double low = 0.0, high = 0.0;  // W
  double bias = 0.0;             // W, by which the coherent power may change with finer launch cells
  double chance = 0.0;           // W, standard error of the power; for one batch estimated from the record
};

// Power that launch cells may hold between rays, W: |a|^2 summed as in random phase, so that a few cells beside a point
// count several times. Of cells without a point of reflection only those at an edge hold anything: they lie at the rim of what they
// see, and of n cells kEdgeCells sqrt(n) at most do. Each batch has cells of its own, all of which hold the same.
double power_between_rays(const CoherentKind& kind, int num_batches);

// Bias: the footprint filter of cells sqrt(2) wider says how fast the coherent field F of a kind goes with the cells. With d its
// change relative to |F|, the field may be off by kOfHalving d |F| where d is small; where it is not, cells are far too wide, and
// what finer ones will find grows to several times the change (kOfHalvingMore). From there on, in full where d reaches kGone, the
// field may also be as large as power_between_rays allows, times kOfBetween. Cells a little finer tell where the filter
// takes edges for a surface without end; what is below kAliases there is the lattice showing through. The changes of all kinds add
// up as fields, but to no less than their root sum of squares, and what else they may hold adds up as power: kinds whose
// echoes cancel are known as well as they are one by one. What wider and what finer cells tell, of one error whose sign neither
// knows, adds up as power, too.
// Chance: Student's t of the batches, and no less than half a hit in each of them, which errs by itself. Of one batch:
// directions drawn at random give the variance sum p^2; a lattice errs along the outline of what it meets alone, so that its
// variance is kOutline^2 sum p^2 / sqrt(n) over n equal hits, and likewise for fields: less so where the filter takes much
// away, as fields of curved surfaces fade toward their outline. The factors are fitted to the coverage of
// `echopath bench crowd`.
PowerInterval power_interval(const PowerEvidence& evidence);

// Returns the two-sided 95 % quantile of Student's t.
double student_t95(int degrees_of_freedom);

}  // namespace echopath
