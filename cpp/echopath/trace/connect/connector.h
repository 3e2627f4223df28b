#pragma once
// Joins the hit of a ray to the receiver.
#include "echopath/trace/connect/chain_connector.h"
#include "echopath/trace/connect/pair_connector.h"

namespace echopath {

// A coherent ray radiates by physical optics at each unflagged hit over every visible receive leg. A diffuse hit gives paths
// of power: a first diffuse hit those over all pairs of legs (pair_connector.h), a later one those of both orders of its
// chain (chain_connector.h), one behind unflagged mirrors those over its receive legs, and their reversals, which no ray
// finds.
template <class Weight>
class Connector {
 public:
  Connector(const RayContext& context, const AntennaLegs& legs)
      : context_(context), legs_(legs), orders_(context), writer_(context), pairs_(context, legs), chains_(context, legs),
        weight_(context) {}
  // Adds the paths of the hit to the block, and keeps the receive legs that it found.
  void connect(Connection& at) const;

 private:
  bool is_near_antenna(const Vec3& point) const;
  void connect_coherent(Connection& at) const;
  void show_lit_plane(Connection& at) const;
  void show_image(Connection& at) const;
  void connect_diffuse(Connection& at) const;

  const RayContext& context_;
  const AntennaLegs& legs_;
  MirrorOrders orders_;
  PathWriter<Weight> writer_;
  PairConnector<Weight> pairs_;
  DiffuseChainConnector<Weight> chains_;
  Weight weight_;
};

extern template class Connector<ScalarWeight>;
extern template class Connector<JonesWeight>;

}  // namespace echopath
