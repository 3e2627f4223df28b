#pragma once
// Follows rays from their launch to their end.
#include "echopath/trace/connect/connector.h"
#include "echopath/trace/sbr/packet_front.h"
#include "echopath/trace/scatter/arrivals.h"
#include "echopath/trace/scatter/scatterer.h"

namespace echopath {

// Joins the parts: PacketFront takes a packet of rays to its first hits, Scatterer and Arrivals take each ray to its next
// hits, and Connector joins each hit to the receiver.
//
// A coherent ray that meets a surface that mirrors and scatters goes on both ways (goes_both_ways).
//
// A ray that meets sheets (Material::layers) is split: one ray is reflected at each sheet, and one goes on through all of
// them to what lets nothing pass. Beyond kMostSplits sheets behind its first hit, a ray only goes on. What sheets do to what
// passes is added to the record at its end (sheets/passes.h).
template <class Weight>
class RayWalk {
 public:
  RayWalk(const RayContext& context, const AntennaLegs& legs, const PacketFront& front)
      : context_(context), front_(front), orders_(context), arrivals_(context), scatterer_(context, legs),
        connector_(context, legs), weight_(context), has_straight_legs_(legs.are_straight()) {}
  // Traces the rays [begin, end) of the plan and appends their paths.
  void shoot(int64_t begin, int64_t end, PathBlock& block) const;

 private:
  struct Scratch;
  void shoot_lane(int lane, Scratch& scratch, PathBlock& block) const;
  void add_plain_echoes(int lane, const Scratch& scratch, PathBlock& block) const;
  void start(int lane, Scratch& scratch) const;
  template <class GoOn>
  void take_beside(Scratch& scratch, PathBlock& block, const GoOn& scatter) const;
  template <class GoOn>
  void branch(Scratch& scratch, PathBlock& block, const GoOn& follow_branch) const;
  void follow(Scratch& scratch, PathBlock& block) const;
  void connect(Scratch& scratch, PathBlock& block) const;
  bool meets(const Vec3& from, const Vec3& direction, Sees sees, RayHit& met, PathBlock& block, double begin = 0.0) const;
  bool arrive(const RayHit& met, Scratch& scratch, PathBlock& block) const;
  void go_on(const ScatterSample& sample, RayHit& met, Scratch& scratch, PathBlock& block) const;
  bool meets_next(const ScatterSample& sample, double begin, Scratch& scratch, RayHit& met, PathBlock& block) const;

  const RayContext& context_;
  const PacketFront& front_;
  MirrorOrders orders_;
  Arrivals arrivals_;
  Scatterer<Weight> scatterer_;
  Connector<Weight> connector_;
  Weight weight_;
  bool has_straight_legs_;
};

extern template class RayWalk<ScalarWeight>;
extern template class RayWalk<JonesWeight>;

}  // namespace echopath
