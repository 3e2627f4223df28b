#pragma once
// Tells what the edges of planes leave of the field of a path over them.
#include <complex>
#include <vector>

#include "echopath/trace/mirrors/mirror_zone.h"

namespace echopath {

// Holds where a path from antenna to antenna bounces off planes, in the order of travel. Of bounces at a common edge the
// surfaces are looked at from beside it, by some spacings of single precision, in which rays know where the edge is.
class PlaneBounces {
 public:
  // The geometry and the patterns of the antennas must outlive it.
  PlaneBounces(const EmbreeScene& geometry, const PosedAntenna& from, const PosedAntenna& to)
      : geometry_(geometry), from_(from), to_(to) {}
  // `normal` is that of the plane, unit, on either side.
  void add(const Hit& hit, const Vec3& point, const Vec3& normal);
  size_t size() const { return points_.size(); }
  // Returns a bounce as the wave sees it that comes from one antenna and goes to the other. It refers to the bounce.
  MirrorView view(size_t bounce) const;
  // Returns the antennas behind the planes on the ways to a bounce, of which `view` is the view.
  UnfoldedAntennas antennas_of(size_t bounce, const MirrorView& view) const;
  // Returns the field of the path over that of endless planes (field_of_flat_mirror); e^{+jwt}.
  std::complex<double> field_beside_edges(double wavelength, int64_t& num_queries) const;
  // Returns whether the planes of a bounce and of the next one meet in a corner without a crack, as far as a few rays can
  // tell.
  bool is_corner_closed(size_t bounce, double wavelength, int64_t& num_queries) const;

 private:
  bool reaches_plane(size_t bounce, size_t other, double wavelength, int64_t& num_queries) const;
  void move_off_edges();

  const EmbreeScene& geometry_;
  PosedAntenna from_, to_;
  std::vector<RayHit> points_;
  std::vector<RayHit> beside_;  // the same, moved off the other planes at an edge
};

}  // namespace echopath
