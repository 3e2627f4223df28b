#include "echopath/power/interval/mesh_views.h"

#include <algorithm>
#include <limits>

#include "echopath/base/constants.h"
#include "echopath/record/hit_points.h"

namespace echopath {
namespace {

// Inside this share of the solid angle of a focus its own rays count, and outside those of the stratum that it is in. Both
// kinds have paths there (trace/launch/launch_focus.h).
constexpr double kShareOfFocus = 0.64;

}  // namespace

MeshViews::MeshViews(const Paths& paths, const Radar& radar)
    : paths_(paths), wavenumber_(kTwoPi * radar.waveform.start_frequency / kSpeedOfLight) {
  const Transform world_from_radar = radar.world_from_radar(paths.frame.trace_time);
  for (size_t k = 0; k < paths.frame.strata.size(); ++k) {
    const Stratum& stratum = paths.frame.strata[k];
    if (stratum.is_focus()) foci_[static_cast<uint16_t>(stratum.focus_of)].push_back(static_cast<uint16_t>(k));
  }
  antennas_ = {world_from_radar * radar.transmitters.front().position, world_from_radar * radar.receivers.front().position};
}

PlaneInView MeshViews::of(int64_t path, uint32_t radiating) {
  const Hit& met = set_key(path, radiating);
  PlaneInView found{index_of_key()};
  View& view = views_[found.view];
  if (!view.body) return found;
  found.plane = view.body->plane_at(met.triangle_id);
  const uint16_t of_ray = paths_.stratum[static_cast<size_t>(path)];
  const Stratum& stratum = paths_.frame.strata[of_ray];
  found.stratum = stratum.is_focus() ? static_cast<uint16_t>(stratum.focus_of) : of_ray;
  found.solid_angle = solid_angle(view, of_ray, found.stratum, met);
  return found;
}

double MeshViews::at_most(uint32_t index, const SeenPlanes& seen) {
  View& view = views_[index];
  if (!view.body) return std::numeric_limits<double>::infinity();
  if (view.waves.empty()) view.waves = view.body->waves(view.antennas, wavenumber_);
  double least = rims_at_most(view.waves, {});
  for (const auto& [stratum, of_planes] : seen) least = std::min(least, rims_at_most(view.waves, of_planes));
  return least;
}

// Sets the key of the path, and returns its hit on the mesh.
const Hit& MeshViews::set_key(int64_t path, uint32_t radiating) {
  const auto index = static_cast<size_t>(path);
  const Hit* hits = paths_.hits_of(path);
  const Hit* met = nullptr;
  const int num_bounces = paths_.num_bounces[index];
  key_.radiating = radiating;
  key_.is_reversed = paths_.is_reversed(index);
  key_.before.clear();
  key_.behind.clear();
  for (int k = 0; k < num_bounces; ++k) {
    const Hit& hit = hits[key_.is_reversed ? num_bounces - 1 - k : k];
    if (hit.mesh_id == radiating) {
      met = &hit;
    } else {
      (met ? key_.behind : key_.before).emplace_back(hit.mesh_id, posed(hit.mesh_id).plane_at(hit.triangle_id));
    }
  }
  return *met;
}

uint32_t MeshViews::index_of_key() {
  if (last_index_ != PlaneInView::kNone && key_ == last_) return last_index_;
  const auto [entry, is_new] = index_.try_emplace(key_, static_cast<uint32_t>(views_.size()));
  if (is_new) views_.push_back(found(key_));
  last_ = key_;
  return last_index_ = entry->second;
}

MeshViews::View MeshViews::found(const Key& key) {
  const Node& node = paths_.scene->node_of(key.radiating);
  const bool is_curved = node.smooth && !node.mesh->is_flat();
  View view;
  if (is_curved || node.mesh->triangles().size() > kMostTriangles) return view;
  const std::vector<Plane> behind = planes(key.behind);
  view.before = planes(key.before);
  view.body = &posed(key.radiating);
  view.antennas.from = image_over(view.before, key.is_reversed ? antennas_.to : antennas_.from);
  view.antennas.to = image_over_reversed(behind, key.is_reversed ? antennas_.from : antennas_.to);
  return view;
}

bool MeshViews::aims_at(View& view, uint16_t index) const {
  const auto [entry, is_new] = view.is_aimed.try_emplace(index);
  if (is_new) {
    const Stratum& stratum = paths_.frame.strata[index];
    const auto meets = [&](const Vec3& vertex) { return stratum.contains(launch_direction(view, vertex)); };
    entry->second = !stratum.is_focus() && std::ranges::all_of(view.body->vertices(), meets);
  }
  return entry->second;
}

Vec3 MeshViews::launch_direction(const View& view, const Vec3& point) const {
  return mirrored_over_reversed(view.before, Vec3(point - view.antennas.from)).normalized();
}

// Each direction counts in one of the strata that share it: in the first focus that is not about to end there, or in the
// one that has the foci.
double MeshViews::solid_angle(View& view, uint16_t of_ray, uint16_t owner, const Hit& met) const {
  if (!aims_at(view, owner)) return 0.0;
  const auto foci = foci_.find(owner);
  if (foci != foci_.end()) {
    const Vec3 direction = launch_direction(view, hit_point(view.body->corners(met.triangle_id), met));
    const auto holds = [&](uint16_t focus) {
      const Stratum& cone = paths_.frame.strata[focus];
      return 0.5 * (direction - cone.axis).squaredNorm() < kShareOfFocus * cone.versine;
    };
    const auto first = std::ranges::find_if(foci->second, holds);
    if ((first == foci->second.end() ? owner : *first) != of_ray) return 0.0;
  }
  return 1.0 / paths_.frame.strata[of_ray].ray_density;
}

const FacetedBody& MeshViews::posed(uint32_t mesh_id) {
  const auto found = bodies_.find(mesh_id);
  if (found != bodies_.end()) return found->second;
  if (!scene_) scene_.emplace(*paths_.scene, paths_.frame.trace_time);
  const Mesh& mesh = *paths_.scene->node_of(mesh_id).mesh;
  return bodies_.try_emplace(mesh_id, scene_->world_vertices(mesh_id), mesh.triangles(), mesh.is_closed()).first->second;
}

std::vector<Plane> MeshViews::planes(const std::vector<std::pair<uint32_t, uint32_t>>& mirrors) {
  std::vector<Plane> found;
  for (const auto& [mesh_id, plane] : mirrors) found.push_back(posed(mesh_id).plane(plane));
  return found;
}

}  // namespace echopath
