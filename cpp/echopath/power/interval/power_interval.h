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
  double image_field = INFINITY;              // sqrt(W), what an endless mirror would send back over the shortest path
  double rims_at_most = INFINITY;             // sqrt(W), of the rims of flat facets (mesh_views.h)
  double facet_phase = 0.0;                   // rad, by which the facets stray from a smooth surface (facet_phase.h)
  double endless_with_edges = 0.0;            // W, sum of |a|^2 that images beside edges (kBesideEdge) had of endless planes
  bool has_cells = false;                     // else its paths are images
  bool has_bounced = false;                   // off other surfaces before, flagged mirrors aside
};

// Holds what the record tells of the power of a set of paths, with all rays.
struct PowerEvidence {
  double coherent = 0.0, diffuse = 0.0;  // W, the estimates
  std::vector<CoherentKind> kinds;
  // These are sums over the coherent paths that hardly change at half the density, such as those of flat surfaces up to
  // their edges: the sum of |a|^2, W, and that of |a|^4, W^2.
  double steady_power = 0.0, steady_squares = 0.0;
  double steady_variance = 0.0;  // W, of the sum of their |a|, where neighbours of a lattice jump (row_differences.h)
  double lattice_squares = 0.0;  // W^2, sum of squares of the powers of diffuse hits that even directions or points found
  double even_variance = 0.0;    // W^2, of the sum of these
  double drawn_squares = 0.0;    // W^2, sum of squares of the powers of those that chance found or kept
  int num_batches = 1;
  double standard_error = 0.0;  // W, of coherent + diffuse by the batches; not used for one
  // This is the power, W, that the coherent paths would send back all in phase. It is set where no footprint filter tells
  // how coarse the rays are.
  std::optional<double> coherent_at_most;
};

// Holds the 95 % interval of a power, and what it is made of.
struct PowerInterval {
  double low = 0.0, high = 0.0;  // W
  // These, W, are the same without what more rays hardly mend, which are facets and edges of several bounces behind a weak
  // field. They tell where rays are needed.
  double low_of_rays = 0.0, high_of_rays = 0.0;
  double bias = 0.0;          // W, by which the coherent power may change with finer launch cells
  double bias_of_rays = 0.0;  // W, the same without what more rays hardly mend
  double chance = 0.0;        // W, standard error of the power; for one batch estimated from the record
};

// Returns the power that launch cells may hold between rays, in W: P + E of the formulas below, with the cells along an edge
// in random phases.
double power_between_rays(const CoherentKind& kind, int num_batches);

// Returns the 95 % interval of the power. It combines a bias, by which the coherent field may be off because launch cells
// are coarse, and the chance of where the rays lie. All factors with a name are fitted to the coverage of `echopath bench
// crowd`.
//
// Symbols of one kind of coherent paths, in B batches: F is its field as launched, F_half that of cells of half the density,
// F_finer that of finer cells (kCellViews). n is the number of equal cells that have the sum and the sum of squares of the
// powers of kEdges. s is how smooth its surface is: facet_phase / kSmoothFacetPhase, at most 1, and 0 behind other bounces.
// The field of a kind may be off by these terms:
//  (1) D = F_half - F, d = |D| / |F|. Wider cells tell how fast the field changes with the cells. It may be larger by
//      min(kOfHalving + kOfHalvingMore d, kMostOfHalving) D, and smaller by kOfHalving D.
//  (2) G = kOfFiner max(0, |F_finer - F| - kAliases |F|). Finer cells tell where the filter takes edges for a surface
//      without end. kAliases |F| is the lattice of rays that shows through.
//  (3) P = B times the power of kPoints: waves of points of reflection that cells hold between rays. As cells outgrow the
//      Fresnel zone of a point, the filter fades its wave about as fast as P outgrows |F|^2. The field may be larger by
//      P / (kPointsTimesField |F|) - |F|, at least 0 and at most kMostOfPoints sqrt(P). Behind other bounces the factor is
//      kPointsTimesFieldOfSeveral. Where F is 0, the field may be larger by kMostOfPoints sqrt(P).
//  (4) E = B w min(1, n / kFewCells) times the power of kEdges: waves of edges that cells hold between rays. w is the share
//      of these cells that lie at an edge, w_0 = min(1, kEdgeCells / sqrt(n / B)), of which the phases are random. Fewer
//      than kFewCells cells mostly lie about a point of reflection that other cells know. Where |F_half| is below kFaded
//      |F|, the cells along an edge may be in phase, as those of a straight edge across the line of sight: w then goes from
//      w_0 to 1, linearly, as |F_half| falls to 0.
//  (5) The field may be larger by sqrt(q e) with e = k^2 E, where k goes from kOfEdges for planes (s = 0) to kOfSmoothEdges
//      for smooth surfaces (s = 1): these end where they are steep, so that their edges hold less, in any phase. So it may
//      also be smaller by sqrt(s q e).
//      What (3) and (5) add, m^2 together, may have any phase where it is larger than F, which then tells of a part of the
//      surface alone: the field may also be smaller by the root of m^2 - |F|^2, and at m^2 = 2 |F|^2 by all of it.
//  (6) q = min(c / kGone, 1)^4 with c = d is the share of e that counts: a field that hardly changes with the cells has its
//      edges. Behind other bounces c is the larger of d and kHalvingPerFiner |F_finer - F| / |F|, as the latter is smaller
//      by that factor where errors fall with the square of a cell's side. There a field that is weaker than its edges may
//      change little by chance: q is at least e / (kKnownAbove |F|^2) - 1, up to 1. Where F is 0, q and w are 1 and s q is
//      0.
//  A surface sends back no more than an endless mirror over the same way. M is the smaller of rims_at_most and kMostOfImage
//  times the field of that mirror, twice it because curved surfaces may gather: (1), (3) and (5) each add at most M, and (2)
//  at most the larger of M and |F|. rims_at_most is known where the wave meets mirrors at most before and behind flat facets
//  of which none reflects it to the receiver. A larger |F| is the lattice of rays that shows through: the field may then be
//  smaller by all of it.
//  (7) No field of launch cells is known better than to kOfSurface |F|, which the lattice and interpolated normals leave,
//      and to min(kOfFacets facet_phase, kMostOfFacets) |F|: where facets stray from the smooth surface that they stand for,
//      rays closer than facets see another field than rays farther apart. Images are exact, but for those beside the edge of
//      an unflagged plane, whose fields are known to kOfEndless of what each had of endless planes.
// Sums over kinds: the changes (1) add up as fields, but to no less than their root sum of squares, and all other terms as
// powers, so that kinds whose echoes cancel are known as well as they are one by one. (1) and (2) measure one error: of
// their two squares the smaller one counts by half. What more rays hardly mend is (7), but for its first term, and the
// lower bound of q in (6). Without a footprint filter nothing tells how coarse the rays are for the phases of a surface: its
// waves may cancel, or add up to coherent_at_most.
//
// The chance of several batches is their standard error times Student's t, and no less than the error of half a hit in each
// batch. That of one batch is estimated from the record. Directions drawn at random give the variance sum p^2. A lattice
// errs where neighbouring rays differ (row_differences.h), and scatterers that stay on their surfaces err by how many of
// them a triangle has (triangle_points.h). Where neighbours are not known, a lattice is taken to err along the outline of
// each piece of a mesh (outlines.h), and fields along one outline of all they meet, so that n equal ones have the variance
// kOutlineOfFields^2 sum |a|^2 / sqrt(n), but less where the filter takes much away, as fields of curved surfaces fade
// toward their outline.
// Posts, bars and spokes have more outlines than one, and may send on from a small part of what rays meet: the standard
// error of a field is at least kJumpsOfFields times that of the sum of |a| by their jumps from ray to ray. Bias and chance
// add up as the root of their sum of squares, to either side.
PowerInterval power_interval(const PowerEvidence& evidence);

// Returns the two-sided 95 % quantile of Student's t.
double student_t95(int degrees_of_freedom);

}  // namespace echopath
