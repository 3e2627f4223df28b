#include "echopath/power/interval/power_interval.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace echopath {
namespace {

constexpr double kNormal = 1.959964;  // two-sided 95 % quantile
constexpr double kOfHalving = 1.2, kOfHalvingMore = 3.0, kMostOfHalving = 5.0;
constexpr double kAliases = 0.007, kOfFiner = 4.0, kHalvingPerFiner = 2.8;
constexpr double kGone = 0.5, kOfEdges = 1.25, kOfSmoothEdges = 0.5, kFaded = 0.2, kKnownAbove = 0.8;
constexpr double kSmoothFacetPhase = 0.1;                                    // rad
constexpr double kPointsTimesField = 4.0, kPointsTimesFieldOfSeveral = 6.0;  // of one bounce and of several
constexpr double kMostOfPoints = 2.5;
constexpr double kOfSurface = 0.0025, kOfFacets = 0.01, kMostOfFacets = 0.015;
constexpr double kMostOfImage = 2.0;
constexpr double kOfEndless = 0.03;  // 0.26 dB, of which random polygons of up to 8 sides err by half at most
constexpr double kOfAHit = 0.5;
constexpr double kEdgeCells = 8.0;  // twice the outline of a square, 4 sqrt(n) of n cells
constexpr double kFewCells = 600.0;
constexpr double kOutlineOfFields = 0.29, kJumpsOfFields = 0.5;

// Says whether an interval counts what more rays hardly mend.
enum class Lasting { kCounted, kLeftOut };

double squared(double x) { return x * x; }

// Returns the number of equal values with the same sum and sum of squares.
double effective_number(double sum, double sum_of_squares) {
  return sum_of_squares > 0.0 ? sum * sum / sum_of_squares : 1.0;
}

// Tells how far the coherent field may lie above and below, sqrt(W).
struct FieldBias {
  double above = 0.0, below = 0.0;
};

// Adds up changes of several kinds; their size is that of the sum, but no less than the root sum of squares of their sizes.
class SumOfChanges {
 public:
  void add(std::complex<double> change) {
    sum_ += change;
    squares_ += std::norm(change);
  }
  double size() const { return std::max(std::abs(sum_), std::sqrt(squares_)); }

 private:
  std::complex<double> sum_ = 0.0;
  double squares_ = 0.0;
};

double between_points(const CoherentKind& kind, int num_batches) { return num_batches * kind.power[kPoints]; }

// `in_phase`: how far, from 0 to 1, the cells along an edge are taken for in phase: n times as much as of random phases.
double between_edges(const CoherentKind& kind, int num_batches, double in_phase) {
  const double edges = kind.power[kEdges], num_cells = effective_number(edges, kind.edge_squares);
  const double of_each = std::min(1.0, kEdgeCells / std::sqrt(num_cells / num_batches));
  return num_batches * edges * std::lerp(of_each, 1.0, in_phase) * std::min(1.0, num_cells / kFewCells);
}

// Returns the most that the field of a kind can be, sqrt(W).
double most_of(const CoherentKind& kind) { return std::min(kMostOfImage * kind.image_field, kind.rims_at_most); }

// Returns by how much the field of a kind may grow by what waves of points hold between rays, sqrt(W).
double missing_of_points(const CoherentKind& kind, int num_batches) {
  const double size = std::abs(kind.field[kAsLaunched]), points = between_points(kind, num_batches);
  const double times_field = kind.has_bounced ? kPointsTimesFieldOfSeveral : kPointsTimesField;
  const double most = std::min(kMostOfPoints * std::sqrt(points), most_of(kind));
  return size > 0.0 ? std::clamp(points / (times_field * size) - size, 0.0, most) : most;
}

// Returns how well, relative to the field of a kind, the facets of its surface let it be known at best.
double of_facets(const CoherentKind& kind, Lasting lasting) {
  return lasting == Lasting::kCounted ? std::min(kOfFacets * kind.facet_phase, kMostOfFacets) : 0.0;
}

// Returns the square of an error of which there are two estimates, from their squares. They are not independent, so that the
// smaller one counts by half.
double of_one_error(double one, double other) { return std::max(one, other) + 0.5 * std::min(one, other); }

// Returns how much of the power that edges may add counts, from 0 to 1. `change`: of the field with the cells, relative to
// it. Behind other bounces a field that is weaker than what edges may add tells nothing: by chance it changes little, too.
double share_of_edges(const CoherentKind& kind, double change, double edges, Lasting lasting) {
  const double by_change = squared(squared(std::min(change / kGone, 1.0))), power = std::norm(kind.field[kAsLaunched]);
  const bool may_hide = kind.has_bounced && lasting == Lasting::kCounted;
  if (!may_hide || edges <= kKnownAbove * power) return by_change;
  return std::max(by_change, std::min(edges / (kKnownAbove * power) - 1.0, 1.0));
}

// Returns how far the edges of a kind are the outlines of smooth surfaces that the wave has met first, from 0 to 1: panels
// that hardly bend end as planes do.
double smoothness_of_edges(const CoherentKind& kind) {
  return kind.has_bounced ? 0.0 : std::min(kind.facet_phase / kSmoothFacetPhase, 1.0);
}

FieldBias field_bias(const PowerEvidence& evidence, Lasting lasting) {
  SumOfChanges above, below;
  double finer = 0.0, points = 0.0, edges = 0.0, edges_below = 0.0, surface = 0.0;  // W
  for (const CoherentKind& kind : evidence.kinds) {
    const double size = std::abs(kind.field[kAsLaunched]);
    const double of_points = squared(missing_of_points(kind, evidence.num_batches));
    points += of_points;
    const double smoothness = smoothness_of_edges(kind);
    const double of_edges = squared(std::lerp(kOfEdges, kOfSmoothEdges, smoothness));
    if (lasting == Lasting::kCounted) surface += squared(kOfEndless) * kind.endless_with_edges;
    if (kind.has_cells) surface += squared(kOfSurface * size) + squared(of_facets(kind, lasting) * size);
    const double most_of_edges = squared(most_of(kind));
    if (size == 0.0) {
      edges += std::min(of_edges * between_edges(kind, evidence.num_batches, 1.0), most_of_edges);
      continue;
    }
    const std::complex<double> change = kind.field[kHalfDensity] - kind.field[kAsLaunched];
    const double halving = std::abs(change) / size;
    const double of_change = std::min(kOfHalving + kOfHalvingMore * halving, kMostOfHalving);
    above.add(std::min(of_change, most_of(kind) / std::abs(change)) * change);
    below.add(kOfHalving * change);
    const double of_finer = std::abs(kind.field[kFiner] - kind.field[kAsLaunched]);
    finer += squared(std::min(kOfFiner * std::max(0.0, of_finer - kAliases * size), std::max(size, most_of(kind))));
    const double in_phase = std::max(0.0, 1.0 - std::abs(kind.field[kHalfDensity]) / (kFaded * size));
    const double most = of_edges * between_edges(kind, evidence.num_batches, in_phase);
    const double still_changes = kind.has_bounced ? std::max(halving, kHalvingPerFiner * of_finer / size) : halving;
    const double missing = std::min(share_of_edges(kind, still_changes, most, lasting) * most, most_of_edges);
    edges += missing;
    const double of_another_phase = std::clamp(of_points + missing - squared(size), 0.0, squared(size));
    edges_below += size > kind.rims_at_most ? squared(size) : std::max(smoothness * missing, of_another_phase);
  }
  return {std::sqrt(of_one_error(squared(above.size()), finer) + points + edges + surface),
          std::sqrt(of_one_error(squared(below.size()), finer) + edges_below + surface)};
}

std::complex<double> field_of(const PowerEvidence& evidence) {
  std::complex<double> field = 0.0;
  for (const CoherentKind& kind : evidence.kinds) field += kind.field[kAsLaunched];
  return field;
}

double power_of(const PowerEvidence& evidence, CellViewIndex view) {
  double power = 0.0;
  for (const CoherentKind& kind : evidence.kinds) power += kind.power[view];
  return power;
}

// Returns the standard error of the power of one batch, W.
double chance_of_record(const PowerEvidence& evidence) {
  const double diffuse = evidence.drawn_squares + evidence.even_variance;
  const double num_rays = effective_number(evidence.steady_power, evidence.steady_squares);
  const double unfiltered = power_of(evidence, kUnfiltered);
  const double hard = unfiltered > 0.0 ? std::min(power_of(evidence, kAsLaunched) / unfiltered, 1.0) : 0.0;
  const double of_one_outline = kOutlineOfFields * std::sqrt(hard * evidence.steady_power / std::sqrt(num_rays));
  const double field = std::max(of_one_outline, kJumpsOfFields * std::sqrt(evidence.steady_variance));
  return std::hypot(2.0 * std::abs(field_of(evidence)) * field + field * field, std::sqrt(diffuse));
}

struct Reach {
  double above = 0.0, below = 0.0;  // W
};

// Returns the standard error, W, of an even lattice that meets a small surface a whole number of times, in each batch by
// itself.
double counting_error(const PowerEvidence& evidence) {
  const double num_hits = effective_number(evidence.diffuse, evidence.lattice_squares + evidence.drawn_squares);
  return evidence.diffuse * kOfAHit * std::sqrt(static_cast<double>(evidence.num_batches)) / std::max(num_hits, 1.0);
}

// Returns the reach by chance. A power that is made of few hits is as uneven as their number, so that the root of a Poisson
// count gives its 95 % limits.
Reach chance_reach(const PowerEvidence& evidence, double power, double standard_error) {
  if (evidence.num_batches > 1) {
    const double reach =
        std::max(standard_error * student_t95(evidence.num_batches - 1), kNormal * counting_error(evidence));
    return {reach, reach};
  }
  if (power <= 0.0) return {kNormal * standard_error, 0.0};
  const double of_root = 0.5 * kNormal * standard_error / power;
  return {power * (squared(1.0 + of_root) - 1.0) + squared(standard_error) / power,
          power * (1.0 - squared(std::max(1.0 - of_root, 0.0)))};
}

// Returns the reach by what the rays have in common.
Reach bias_reach(const PowerEvidence& evidence, double coherent, Lasting lasting) {
  if (evidence.coherent_at_most) return {std::max(*evidence.coherent_at_most - coherent, 0.0), coherent};
  const FieldBias bias = field_bias(evidence, lasting);
  const double size = std::sqrt(coherent);
  return {squared(size + bias.above) - coherent, coherent - squared(std::max(size - bias.below, 0.0))};
}

}  // namespace

double power_between_rays(const CoherentKind& kind, int num_batches) {
  return between_points(kind, num_batches) + between_edges(kind, num_batches, 0.0);
}

double student_t95(int degrees_of_freedom) {
  constexpr double kFew[] = {12.706205, 4.302653, 3.182446, 2.776445, 2.570582};
  if (degrees_of_freedom <= 5) return kFew[std::max(degrees_of_freedom, 1) - 1];
  // This is Cornish and Fisher's expansion, off by 1e-3 at most.
  const double z = kNormal, per = 1.0 / degrees_of_freedom, z2 = z * z;
  return z * (1.0 + per * ((z2 + 1.0) / 4.0 + per * ((5.0 * z2 * z2 + 16.0 * z2 + 3.0) / 96.0 +
                                                     per * (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0)));
}

PowerInterval power_interval(const PowerEvidence& evidence) {
  const double coherent = std::max(evidence.coherent, 0.0), power = coherent + evidence.diffuse;
  const bool has_batches = evidence.num_batches > 1;
  PowerInterval out;
  out.chance = has_batches ? evidence.standard_error : chance_of_record(evidence);
  const Reach chance = chance_reach(evidence, power, out.chance);
  const auto bounds = [&](const Reach& bias) {
    return std::pair(std::max(power - std::hypot(bias.below, chance.below), 0.0),
                     power + std::hypot(bias.above, chance.above));
  };
  const Reach bias = bias_reach(evidence, coherent, Lasting::kCounted);
  out.bias = bias.above;
  std::tie(out.low, out.high) = bounds(bias);
  const Reach of_rays = bias_reach(evidence, coherent, Lasting::kLeftOut);
  out.bias_of_rays = of_rays.above;
  std::tie(out.low_of_rays, out.high_of_rays) = bounds(of_rays);
  return out;
}

}  // namespace echopath
