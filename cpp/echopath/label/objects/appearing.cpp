#include "echopath/label/objects/appearing.h"

#include <algorithm>
#include <array>
#include <set>

#include "echopath/base/threads/parallel.h"
#include "echopath/label/objects/object_view.h"
#include "echopath/trace/embree/kept_geometry.h"
#include "echopath/trace/launch/launch_directions.h"
#include "echopath/trace/launch/launch_points.h"

namespace echopath {
namespace {

constexpr double kBeforeSelf =
    1e-4;  // relative to the distance: nearer to a point than this it is its own surface that hides it
constexpr int64_t kMostDirections = 16;  // for each one on the object

Transform place_of(const PosedScene& pose, uint32_t mesh) {
  Transform place;
  place.linear() = pose.linear(mesh);
  place.translation() = pose.world_translation(mesh);
  return place;
}

// Holds the points of an object that one end meets, and what hides any of them.
struct SeenPoints {
  struct Point {
    uint32_t mesh;
    Vec3 position;    // in the frame of its mesh
    uint32_t hiding;  // mesh, or kNothing
  };
  std::vector<Point> points;
  std::set<uint32_t> hiding;
};

class Watch {
 public:
  Watch(const Scene& scene, const Radar& radar, const SurfaceMap& surfaces, const AppearingSettings& settings,
        const PosedScene& pose, const EmbreeScene& geometry)
      : scene_(scene), radar_(radar), surfaces_(surfaces), settings_(settings), pose_(pose), geometry_(geometry) {
    for (const double time : settings.others) others_.emplace_back(scene, time);
  }

  bool may_appear(uint32_t object) const {
    const std::array<SeenPoints, 2> seen = {points_from(object, radar_.transmitters), points_from(object, radar_.receivers)};
    if (!std::ranges::all_of(seen, [this](const SeenPoints& one) { return can_be_followed(one); })) return true;
    return std::ranges::any_of(others_, [&](const PosedScene& other) {
      return share_in_sight(seen[0], radar_.transmitters, other) > settings_.hidden_share &&
             share_in_sight(seen[1], radar_.receivers, other) > settings_.hidden_share;
    });
  }

 private:
  Vec3 position_of(const std::vector<Antenna>& antennas, double time) const {
    return mean_position(antennas, radar_.world_from_radar(time));
  }

  bool can_be_followed(const SeenPoints& seen) const {
    const auto is_rigid = [this](uint32_t mesh) { return scene_.node_of(mesh).deformation == nullptr; };
    return !seen.points.empty() && std::ranges::all_of(seen.hiding, is_rigid) &&
           std::ranges::all_of(seen.points, [&](const auto& point) { return is_rigid(point.mesh); });
  }

  SeenPoints points_from(uint32_t object, const std::vector<Antenna>& antennas) const {
    const ObjectView view(geometry_, surfaces_, object, position_of(antennas, pose_.time()) - geometry_.origin());
    const Stratum stratum = view.stratum(false);
    SeenPoints seen = points_in(view, stratum, settings_.num_directions);
    const int64_t found = std::ssize(seen.points), asked = settings_.num_directions;
    if (2 * found < asked)
      seen = points_in(view, stratum, asked * std::min(kMostDirections, asked / std::max<int64_t>(1, found)));
    return seen;
  }

  SeenPoints points_in(const ObjectView& view, const Stratum& stratum, int64_t num_directions) const {
    const LaunchDirections launch({stratum});
    const auto lattice = launch_points(Sampler::kLattice, domain_of(stratum), num_directions, {Eigen::Vector2d(0.5, 0.5)});
    SeenPoints found;
    for (int64_t begin = 0; begin < num_directions; begin += kPacketSize) {
      const int count = static_cast<int>(std::min<int64_t>(kPacketSize, num_directions - begin));
      LaneValues x{}, y{};
      lattice->points(begin, count, x.lanes, y.lanes);
      LaneVectors directions;
      launch.launch(0, x, y, {0, kPacketSize}, directions);
      ObjectView::Seen seen;
      view.look(directions, count, seen);
      add(view, directions, count, seen, found);
    }
    return found;
  }

  void add(const ObjectView& view, const LaneVectors& directions, int count, const ObjectView::Seen& seen,
           SeenPoints& found) const {
    for (int lane = 0; lane < count; ++lane) {
      if (seen.surface[lane] == ObjectView::kNothing) continue;
      const Vec3 point = geometry_.origin() + view.apex() + seen.distance[lane] * directions[lane];
      found.points.push_back({seen.mesh[lane], place_of(pose_, seen.mesh[lane]).inverse() * point, seen.hiding[lane]});
      if (seen.hiding[lane] != ObjectView::kNothing) found.hiding.insert(seen.hiding[lane]);
    }
  }

  double share_in_sight(const SeenPoints& seen, const std::vector<Antenna>& antennas, const PosedScene& other) const {
    const Vec3 antenna = position_of(antennas, other.time());
    int64_t num_in_sight = 0;
    for (const SeenPoints::Point& point : seen.points) {
      const Vec3 place = place_of(other, point.mesh) * point.position;
      const auto is_hidden_by = [&](uint32_t mesh) { return hides(mesh, other, antenna, place); };
      if (point.hiding != ObjectView::kNothing && is_hidden_by(point.hiding)) continue;
      if (std::ranges::none_of(seen.hiding, is_hidden_by)) ++num_in_sight;
    }
    return static_cast<double>(num_in_sight) / static_cast<double>(seen.points.size());
  }

  // Tells whether a mesh cuts a segment at another time: that from where it was to where the segment lay beside it.
  bool hides(uint32_t mesh, const PosedScene& other, const Vec3& from, const Vec3& to) const {
    const Transform back = place_of(pose_, mesh) * place_of(other, mesh).inverse();
    const Vec3 begin = back * from - geometry_.origin(), line = back * to - geometry_.origin() - begin;
    const double length = line.norm();
    LaneVectors directions;
    for (int lane = 0; lane < kPacketSize; ++lane) directions.set(lane, unpacked(line / length));
    EmbreeScene::Stretches stretch{};
    stretch.end[0] = length * (1.0 - kBeforeSelf);
    EmbreeScene::MeshHits met;
    while (true) {
      geometry_.intersect_meshes(begin, directions, stretch, geometry_.mask_of(mesh), met);
      if (met.mesh_id[0] == mesh || met.mesh_id[0] == kNoMesh) return met.mesh_id[0] == mesh;
      stretch.begin[0] = met.distance[0] * ObjectView::kAfter;
    }
  }

  const Scene& scene_;
  const Radar& radar_;
  const SurfaceMap& surfaces_;
  const AppearingSettings& settings_;
  const PosedScene& pose_;
  const EmbreeScene& geometry_;
  std::vector<PosedScene> others_;
};

}  // namespace

std::vector<uint32_t> may_appear(const Scene& scene, const Radar& radar, const SurfaceMap& surfaces,
                                 std::span<const uint32_t> objects, const AppearingSettings& settings, Job* job,
                                 KeptGeometry* kept) {
  if (objects.empty()) return {};
  const PosedScene pose(scene, settings.time);
  const Vec3 near = mean_position(radar.transmitters, radar.world_from_radar(settings.time));
  const GeometryLoan geometry(kept, scene, pose, near, EmbreeScene::upkeep_near(radar.is_moving()), job);
  const Watch watch(scene, radar, surfaces, settings, pose, *geometry);
  std::vector<uint8_t> appears(objects.size());
  parallel_for(std::ssize(objects), [&](int64_t i) { appears[i] = watch.may_appear(objects[i]); }, job);
  std::vector<uint32_t> found;
  for (size_t i = 0; i < objects.size(); ++i) {
    if (appears[i]) found.push_back(objects[i]);
  }
  return found;
}

}  // namespace echopath
