#pragma once
// Records which planes an antenna lights over which other planes, as rays found it. Edges on a lit plane have echoes over
// the same mirrors (edges_over_planes.h), though nobody flagged these.
#include <map>
#include <span>
#include <vector>

#include "echopath/base/plane.h"
#include "echopath/record/blocks/path_block.h"
#include "echopath/trace/embree/embree_scene.h"

namespace echopath {

// Says that waves from an antenna light a plane over mirrors, all of them indices of planes.
struct LitPlane {
  std::vector<int> mirrors;  // in order of travel from the antenna
  int plane;
  Box box;  // m: where rays met it, and the space to the rays beside them
};

// Holds the planes of the facets that mirrored a ray or at which a mirrored ray arrived. Facets of sheets are left out,
// because rays go through them. Facets that lie in one plane to a sixteenth of the wavelength are one plane,
// whatever meshes they belong to.
class LitPlanes {
 public:
  // All must outlive it.
  LitPlanes(const Scene& scene, const EmbreeScene& geometry, double wavelength);
  // Takes what the rays of a block found.
  void add_chains(const PathBlock& block);
  // Ends the search: sorts what was found, so that it does not depend on the order of the rays. `antenna_distance` is that
  // between transmitter and receiver in m.
  void finish(double antenna_distance);
  // Return the planes that waves from each antenna would light. Rays come from the transmitter alone: what the receiver
  // lights is the same where both stand at one place; else the chains of planes that rays met count backwards, too. `finish`
  // must have been called.
  const std::vector<LitPlane>& from_transmitter() const { return from_transmitter_; }
  const std::vector<LitPlane>& from_receiver() const { return from_receiver_; }
  const std::vector<Plane>& planes() const { return planes_; }
  // Returns the plane on which a facet lies, -1 where it lies on none.
  int plane_of(const Hit& hit) const;
  // Returns the plane in which all these points lie, -1 where there is none. `normal` is the unit normal of their own plane.
  int plane_through(std::span<const Vec3> points, const Vec3& normal) const;

 private:
  using Boxes = std::vector<Box>;  // of each facet of a chain
  using Found = std::map<std::pair<std::vector<int>, int>, Box>;

  bool may_mirror(const Hit& hit) const;
  void find_planes();
  static std::vector<LitPlane> sorted(const Found& found);

  const Scene& scene_;
  const EmbreeScene& geometry_;
  double tolerance_;  // m
  std::map<std::vector<TriangleName>, Boxes> chains_;
  std::map<TriangleName, int> plane_of_facet_;
  std::vector<Plane> planes_;
  std::vector<std::pair<double, int>> by_slope_;  // planes by a key that nearly parallel ones share
  std::vector<LitPlane> from_transmitter_, from_receiver_;
};

}  // namespace echopath
