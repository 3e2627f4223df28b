#pragma once
// A block of a record's paths with all that does not depend on time: hits in the frames of their meshes, launch cells.
#include <array>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "echopath/replay/path_geometry.h"

namespace echopath {

struct LocalPaths {
  std::vector<LocalPath> paths;
  int longest = 0;  // hits of a path at most

  // What the paths point into.
  std::vector<LocalHit> hits;
  std::deque<std::array<Vec3, 3>> normals;
};

// A hit in the frame of its mesh, without its normals.
LocalHit local_hit(const Scene& scene, const Hit& hit);
// Normals of its corners from those of its mesh's vertices, at rest; false where the crease guard refuses the facet.
bool find_smooth_normals(const LocalHit& hit, const std::vector<Vec3>& of_vertices, std::array<Vec3, 3>& out);

// Thread-safe.
class Localiser {
 public:
  // The record must outlive it.
  explicit Localiser(const Paths& paths);
  // The paths of these indices, hits in the order in which they were traced.
  LocalPaths operator()(std::span<const int64_t> indices) const;
  // Unit vertex normals by mesh ID, at rest; empty where facets are meant.
  const std::vector<std::vector<Vec3>>& smooth_normals() const { return smooth_normals_; }

 private:
  LocalPath local_path(int64_t index, LocalPaths& block) const;
  void add_cell(LocalPath& path, int64_t index, std::vector<PosedHit>& scratch) const;
  void set_flat_cell(LocalPath& path, std::vector<PosedHit>& scratch) const;

  const Paths& paths_;
  std::vector<uint8_t> mesh_is_mirror_;            // by mesh ID
  std::vector<std::vector<Vec3>> smooth_normals_;
  Instant trace_instant_;
};

}  // namespace echopath
