#include "echopath/trace/paths.h"

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"

namespace echopath {
namespace {

template <class T>
std::vector<T> kept(const std::vector<T>& values, const std::vector<uint8_t>& keep) {
  std::vector<T> out;
  for (size_t i = 0; i < keep.size(); ++i) {
    if (keep[i]) out.push_back(values[i]);
  }
  return out;
}

}  // namespace

double Stratum::solid_angle() const { return kTwoPi * versine; }

bool Stratum::contains(const Vec3& direction) const { return 0.5 * (direction - axis).squaredNorm() <= versine; }

void Paths::validate() const {
  const size_t size = offsets.size();
  require(num_bounces.size() == size && diffuse.size() == size && weight.size() == size && stratum.size() == size &&
              batch.size() == size && flags.size() == size && (curved_cell.empty() || curved_cell.size() == size),
          "paths", "all arrays must have one entry per path, paths", size);
  for (size_t i = 0; i < size; ++i) {
    require(num_bounces[i] >= 1 && num_bounces[i] <= 64, "num_bounces", "must lie in [1, 64]", int{num_bounces[i]});
    require(offsets[i] >= 0 && offsets[i] + num_bounces[i] <= num_hits(), "offsets", "must lead to hits", offsets[i]);
    require(batch[i] == kNoBatch || batch[i] < frame.num_batches, "batch", "must be one of the frame's", int{batch[i]});
    require(stratum[i] == 255 || stratum[i] < frame.strata.size(), "stratum", "must be one of the frame's", int{stratum[i]});
  }
  for (int64_t i = 0; i < num_hits(); ++i) {
    const Hit& hit = (*hits)[static_cast<size_t>(i)];
    require(hit.mesh_id < scene->meshes().size(), "mesh_id", "must be a mesh of the scene", hit.mesh_id);
    const size_t num_triangles = scene->node_of(hit.mesh_id).mesh->triangles().size();
    require(hit.triangle_id < num_triangles, "triangle_id", "must be a triangle of its mesh", hit.triangle_id);
  }
}

Paths Paths::select(const std::vector<uint8_t>& keep) const {
  require(static_cast<int64_t>(keep.size()) == num_paths(), "keep", "must have one entry per path", keep.size());
  Paths out;
  out.hits = hits;
  out.offsets = kept(offsets, keep);
  out.num_bounces = kept(num_bounces, keep);
  out.diffuse = kept(diffuse, keep);
  out.weight = kept(weight, keep);
  out.stratum = kept(stratum, keep);
  out.batch = kept(batch, keep);
  out.flags = kept(flags, keep);
  if (!curved_cell.empty()) out.curved_cell = kept(curved_cell, keep);
  out.scene = scene;
  out.radar = radar;
  out.frame = frame;
  return out;
}

}  // namespace echopath
