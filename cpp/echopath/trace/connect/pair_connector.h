#pragma once
// Joins a first diffuse hit over all pairs of its visible transmit and receive legs.
#include "echopath/trace/connect/path_writer.h"

namespace echopath {

// The ray came directly or over at most kMaxLegMirrors flagged mirrors. Rays could have found the hit over each of its
// transmit legs, so all pairs have the same balance weight over these ways (Veach 1997). Where rays are aimed at points of
// rough surfaces, these alone make all pairs of a hit that they see.
template <class Weight>
class PairConnector {
 public:
  PairConnector(const RayContext& context, const AntennaLegs& legs)
      : context_(context), legs_(legs), writer_(context), weight_(context) {}
  // Adds the paths over all pairs. The receive legs must have been found, at least one.
  void connect(Connection& at) const;

 private:
  bool is_left_to_points(const Connection& at) const;
  double material_area(const Connection& at) const;
  void write_fan(Connection& at, std::complex<double> weight) const;

  const RayContext& context_;
  const AntennaLegs& legs_;
  PathWriter<Weight> writer_;
  Weight weight_;
};

extern template class PairConnector<ScalarWeight>;
extern template class PairConnector<JonesWeight>;

}  // namespace echopath
