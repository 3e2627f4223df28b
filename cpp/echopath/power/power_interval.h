#pragma once
// Computes the 95 % interval of a received power from what the launch cells take away and what chance adds.
#include <complex>
#include <optional>
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
  std::complex<double> field[kNumCellViews];  // sqrt(W)
  double power[kNumCellViews] = {};           // W, sum of |a|^2
  double edge_squares = 0.0;                  // W^2, sum of |a|^4 of kEdges
  double facet_phase = 0.0;                   // rad, by which the facets stray from a smooth surface (facet_phase.h)
  bool has_cells = false;                     // else its paths are images, which are exact
  bool has_bounced = false;                   // off other surfaces before, flagged mirrors aside
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
  // W, where no footprint filter tells how coarse the rays are: what the coherent paths would send back all in phase.
  std::optional<double> coherent_at_most;
};

struct PowerInterval {
  double low = 0.0, high = 0.0;  // W
  // W: the same without what more rays hardly mend, which are facets and edges of several bounces behind a weak field. It
  // tells where rays are needed.
  double low_of_rays = 0.0, high_of_rays = 0.0;
  double bias = 0.0;          // W, by which the coherent power may change with finer launch cells
  double bias_of_rays = 0.0;  // W, the same without what more rays hardly mend
  double chance = 0.0;        // W, standard error of the power; for one batch estimated from the record
};

// Returns the power that launch cells may hold between rays, W. It sums |a|^2 as for random phases, so that a few cells
// beside a point count several times. Of n cells without a point of reflection, kEdgeCells sqrt(n) at most lie at an edge,
// and where they are fewer than kFewCells they mostly lie about the foot of a wave that the others know, not along an edge.
// Each batch has cells of its own, and the cells of every batch hold the same.
double power_between_rays(const CoherentKind& kind, int num_batches);

// Bias: the footprint filter of cells sqrt(2) wider tells how fast the coherent field F of a kind changes with the cells.
// With d the change relative to |F|, the field may be off by kOfHalving d |F| where d is small, and by kOfHalvingMore d
// times as much more where cells are too wide. Cells a little finer tell where the filter takes edges for a surface without
// end: the field may be off by kOfFiner times the change there, of which kAliases |F| is the lattice showing through. Both
// changes measure one error: of the two estimates the square of the smaller one counts by half.
// Between rays: the filter fades the wave of a point of reflection as cells outgrow its Fresnel zone, about as fast as what
// cells hold of such points, P (power_between_rays), outgrows |F|^2. The field may then be as large as
// P / (kPointsTimesField |F|), but larger than it is by no more than kMostOfPoints sqrt(P). Of waves of edges it may lack
// kOfEdges times as much as cells hold, in full where d reaches kGone; behind other bounces also where kHalvingPerFiner
// times the change to finer cells does, by which that change is smaller where errors fall with the square of a cell's side,
// and where the field is weaker than the edges: it may then change little by chance. Smooth surfaces end where they are
// steeper than on average, so that their edges hold less, in any phase: what people lack of them is kOfSmoothEdges / 2 times
// as much, root mean square. Their field may be off by kOfSmoothEdges times as much to either side. A surface is that smooth
// where its facets stray by kBentFacets from it, and ends as a plane does where they do not at all.
// Where cells twice as large leave less than kFaded of the field, cells along an edge may be in phase, as are those of a
// straight edge across the line of sight.
// The changes of all kinds add up as fields, but to no less than their root sum of squares, and all else as powers: kinds
// whose echoes cancel are known as well as they are one by one. No field of a kind is known better than to kOfSurface,
// however fine the cells: that is what the lattice and interpolated normals leave. Where facets stray from the smooth
// surface that they stand for, rays closer than facets see another field than rays farther apart: it is known to kOfFacets
// for each radian by which they do, up to kMostOfFacets.
// Without a footprint filter nothing tells how coarse the rays are for the phases of a surface: its waves may cancel, or add
// up as coherent_at_most has them.
// Chance: with batches it is Student's t of these, and no less than half a hit in each of them, which errs by itself. For
// one batch, directions drawn at random give the variance sum p^2. A lattice errs only along the outline of what it meets,
// so that its variance is kOutline^2 sum p^2 / sqrt(n) over n equal hits. The same holds for fields, but less where the
// filter takes much away, as fields of curved surfaces fade toward their outline. The factors are fitted to the coverage of
// `echopath bench crowd`.
PowerInterval power_interval(const PowerEvidence& evidence);

// Returns the two-sided 95 % quantile of Student's t.
double student_t95(int degrees_of_freedom);

}  // namespace echopath
