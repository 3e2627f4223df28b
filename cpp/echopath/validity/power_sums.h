#pragma once
// Sums what the check of a frame finds of paths, each by its power.
#include "echopath/validity/validity.h"
#include "echopath/validity/validity_objects.h"

namespace echopath {

// Holds sums of power over paths, W.
struct PowerSums {
  double power = 0.0, squared = 0.0, slid = 0.0, left = 0.0, blocked = 0.0, turned = 0.0, beside_edges = 0.0;

  void add(const PathState& state, double p, double phase) {
    power += p;
    squared += p * phase * phase;
    if (phase > kPhaseLimit) slid += p;
    if (state.left != 0) left += p;
    if (state.blocked != 0 || state.is_receiver_blocked) blocked += p;
    if (state.is_turned) turned += p;
    if (state.edge_change > kEdgeLimit) beside_edges += p;
  }
  void add(const PowerSums& other, double scale = 1.0) {
    power += scale * other.power;
    squared += scale * other.squared;
    slid += scale * other.slid;
    left += scale * other.left;
    blocked += scale * other.blocked;
    turned += scale * other.turned;
    beside_edges += scale * other.beside_edges;
  }
  ValidityShares shares() const {
    const double unit = power > 0 ? 1.0 / power : 0.0;
    return {power, unit * slid, unit * left, unit * blocked, unit * turned, unit * beside_edges, 0.0};
  }
};

// Sums physical-optics paths, which add up as fields, apart from the others, which add up as powers.
struct KindSums {
  PowerSums field, power;
  BandSum together;  // of the physical-optics paths at the trace time

  PowerSums combined(double field_scale) const {
    PowerSums sum = power;
    sum.add(field, field_scale);
    return sum;
  }
  // Returns the ratio of the power of the sum of the physical-optics paths, averaged over the band, to their sum of |a|^2.
  double field_scale() const { return field.power > 0 ? together.power() / field.power : 1.0; }
};

}  // namespace echopath
