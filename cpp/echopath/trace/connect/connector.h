#pragma once
// Joins the hit of a ray to the receiver.
#include "echopath/trace/connect/diffuse_chain.h"
#include "echopath/trace/connect/mirror_orders.h"
#include "echopath/trace/sbr/weight.h"

namespace echopath {

// A coherent ray radiates by physical optics at each unflagged hit over every visible receive leg. A diffuse hit gives paths
// of power: a first diffuse hit those over all pairs of legs, a later one those of both orders of its chain, one behind
// unflagged mirrors those over its receive legs, and their reversals, which no ray finds.
template <class Weight>
class Connector {
 public:
  Connector(const RayContext& context, const AntennaLegs& legs)
      : context_(context), legs_(legs), orders_(context), chain_orders_(context), weight_(context) {}
  // Adds the paths of the hit to the block, and keeps the receive legs that it found.
  void connect(Connection& at) const;

 private:
  bool is_near_antenna(const Vec3& point) const;
  void connect_coherent(Connection& at) const;
  void show_lit_plane(Connection& at) const;
  void show_image(Connection& at) const;
  void connect_diffuse(Connection& at) const;
  void connect_pairs(Connection& at) const;
  bool is_left_to_points(const Connection& at) const;
  double material_area(const Connection& at) const;
  void write_fan(Connection& at, std::complex<double> weight) const;
  void connect_chain(Connection& at) const;
  void write(Connection& at, const Leg& leg, uint64_t diffuse, std::complex<double> weight, const OrderShares& shares) const;
  void write_reversed(Connection& at, const Leg& leg, uint64_t diffuse, std::complex<double> weight) const;
  void set_columns(Connection& at, const Leg& leg, uint64_t diffuse) const;

  const RayContext& context_;
  const AntennaLegs& legs_;
  MirrorOrders orders_;
  DiffuseChainOrders chain_orders_;
  Weight weight_;
};

extern template class Connector<ScalarWeight>;
extern template class Connector<JonesWeight>;

}  // namespace echopath
