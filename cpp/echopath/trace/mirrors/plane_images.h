#pragma once
// Finds the paths over planes that nobody flagged, by images.
//
// Rays tell which planes to try: a coherent ray whose hits reflect it to within a few spacings of rays of the receiver names
// the planes of one path (its chain), as in the method of shooting and bouncing rays with a sphere around the receiver. The
// image method finds the path itself, to rounding, in the order of the chain or in another one: about a corner rays come
// back in all orders, and the one that the path has may be that of hardly any of them. It counts where each of its surfaces
// is larger than its Fresnel zone (mirror_zone.h): then the field is that of geometrical optics, with what the edges near
// its points leave of it (field_of_flat_mirror), and the echoes by physical optics that rays send over the same planes in
// the same order are left out, because they add up to the same field. Everything else stays with the rays: smaller surfaces,
// planes without a point of reflection, diffuse echoes, paths that meet anything else. Source: Schaubach, Davis, Rappaport
// 1992 (sphere around the receiver).
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/record/blocks/path_block.h"
#include "echopath/trace/mirrors/image_method.h"
#include "echopath/trace/mirrors/plane_bounces.h"
#include "echopath/trace/mirrors/plane_doubles.h"

namespace echopath {

class PlaneImages {
 public:
  // All must outlive it but the antennas, whose patterns must: of those, beams count at the edges of planes, and the places
  // are those of the settings.
  PlaneImages(const Scene& scene, const EmbreeScene& geometry, const SbrSettings& settings, PosedAntenna transmitter,
              PosedAntenna receiver);
  // Takes the chains that the rays of a block found.
  void add_chains(const PathBlock& block);
  // Finds the paths over these chains, each once, and writes them to a block. Raises Cancelled when the job is cancelled.
  PathBlock find(const Job* job);
  // Returns which of the rays' paths the images stand for.
  const PlaneDoubles& doubles() const { return doubles_; }

 private:
  struct RayChain {
    size_t first;  // in facets_
    uint32_t count;
  };
  using Facets = std::span<const TriangleName>;  // the surfaces of each hit
  Facets facets_of(const RayChain& chain) const { return {facets_.data() + chain.first, chain.count}; }
  void sort_chains();
  std::vector<int> planes_of(Facets chain);
  void try_order(const std::vector<int>& sequence, PathBlock& block);
  bool is_known(const std::vector<int>& sequence, const std::vector<Vec3>& points);
  std::optional<std::complex<double>> field_beside_edges(const PlaneBounces& bounces, int64_t& num_queries) const;
  std::vector<int> joined(const std::vector<int>& sequence);
  bool is_same_plane(const Mirror& plane, const Mirror& other) const;
  void leave_out(const std::vector<int>& planes, const std::vector<Vec3>& points, const PlaneBounces& bounces,
                 int64_t& num_queries);
  void find_triangles();

  const Scene& scene_;
  const EmbreeScene& geometry_;
  const SbrSettings& settings_;
  PosedAntenna transmitter_, receiver_;
  double wavelength_;                 // m
  double tolerance_;                  // m: surfaces that stray no farther from a plane are parts of it
  std::vector<TriangleName> facets_;  // of all rays with chains, which the chains of a ray share
  std::vector<RayChain> chains_;
  std::vector<Mirror> planes_;  // of the chain at hand
  // These are the points of the sequences tried and places beside them along the normals, by their meshes and by where the
  // first point lies along a line.
  std::map<std::vector<uint32_t>, std::multimap<double, std::vector<Vec3>>> tried_;
  size_t num_tried_points_ = 0;
  std::vector<Mirror> joined_;            // planes of the paths found
  std::set<std::vector<int>> sequences_;  // the paths found, by joined planes
  PlaneDoubles doubles_;
};

}  // namespace echopath
