#include "echopath/label/objects/visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/label/objects/nearest_point.h"
#include "echopath/label/objects/object_view.h"
#include "echopath/label/objects/visibility_grid.h"
#include "echopath/trace/embree/kept_geometry.h"

namespace echopath {
namespace {

constexpr int kGridCells = 2;           // for each direction asked for, at first
constexpr double kLeastFill = 0.25;     // share of cells on the object below which there are to be more
constexpr double kLooseFill = 0.2;      // below which the stratum is fitted to the vertices
constexpr double kMostCells = 16.0;     // for each direction asked for
constexpr int64_t kEnoughHidden = 256;  // directions on an object, all hidden by one surface, after which all of it is
// Ends that are nearer to each other than kNearEnds of the distance to an object may see the same outline of it. They do if
// it moves, which goes by the depth of the object, by no more than kSameOutline of its width from one end to the other.
constexpr double kNearEnds = 0.01, kSameOutline = 0.05;

// Holds the antennas of one end of the radar.
struct End {
  Vec3 position;  // mean, relative to the origin
  std::vector<PosedAntenna> antennas;

  bool has_gain_toward(const Vec3& direction) const {
    return std::ranges::any_of(antennas, [&](const PosedAntenna& antenna) { return antenna.toward(direction).power > 0.0; });
  }
};

// Finds what hides one object from one end, or from both where they are near each other. Its outline is that which the first
// one sees.
class ObjectScanner {
 public:
  ObjectScanner(const EmbreeScene& geometry, const SurfaceMap& surfaces, uint32_t object, std::span<const End> ends)
      : geometry_(geometry), surfaces_(surfaces), object_(object), ends_(ends) {
    for (const End& end : ends) views_.emplace_back(geometry, surfaces, object, end.position);
  }

  // Returns what each end sees, but for the distances.
  std::vector<VisibilityFromEnd> visibilities(int num_directions) {
    const VisibilityGrid grid = looked_at(views_.front().stratum(false), num_directions);
    std::vector<VisibilityFromEnd> visibilities;
    for (size_t end = 0; end < ends_.size(); ++end) visibilities.push_back(visibility_from(end, grid));
    return visibilities;
  }

  double extent() const { return views_.front().extent(); }  // m, of the object

 private:
  // Names what the ends meet in one direction, the object or what hides it.
  using Met = std::array<uint32_t, 2>;

  // Looks at as many cells as it takes to have so many directions on the object.
  VisibilityGrid looked_at(Stratum stratum, int num_directions) {
    const VisibilityGrid::FindMet find_met = [this](const LaneVectors& directions, int count, uint32_t* met) {
      see(directions, count, met);
    };
    VisibilityGrid grid(stratum, int64_t{kGridCells} * num_directions);
    double fill = grid.start(find_met);
    if (fill < kLooseFill && !is_hidden(grid)) {
      stratum = views_.front().stratum(true);
      grid = VisibilityGrid(stratum, int64_t{kGridCells} * num_directions);
      fill = grid.start(find_met);
    }
    if (fill < kLeastFill && !is_hidden(grid)) {
      const double cells = fill > 0.0 ? std::min(kMostCells, 1.0 / fill) : kMostCells;
      grid = VisibilityGrid(stratum, static_cast<int64_t>(cells * num_directions));
      fill = grid.start(find_met);
    }
    if (fill == 0.0) grid.finish_everywhere(find_met);
    else if (!is_hidden(grid)) grid.finish(find_met);
    return grid;
  }

  // Returns whether one surface hides the object wherever it was looked for first, in enough directions.
  bool is_hidden(const VisibilityGrid& grid) const {
    const std::optional<uint32_t> only = grid.only_met(kEnoughHidden);
    if (!only) return false;
    const std::span<const uint32_t> by_end = std::span(met_[*only]).first(ends_.size());
    return std::ranges::find(by_end, object_) == by_end.end();
  }

  void see(const LaneVectors& directions, int count, uint32_t* met) {
    ObjectView::Seen seen;
    views_.front().look(directions, count, seen);
    std::array<uint32_t, kPacketSize> others{};
    if (ends_.size() > 1) views_.front().look_from(ends_[1].position, directions, seen, count, others.data());
    for (int lane = 0; lane < count; ++lane) {
      met[lane] = seen.surface[lane] == ObjectView::kNothing ? VisibilityGrid::kNothing
                                                             : number_of({seen.surface[lane], others[lane]});
      if (met[lane] != VisibilityGrid::kNothing) look_for_gain(directions[lane]);
    }
  }

  // Returns the number under which the grid knows what is met.
  uint32_t number_of(const Met& met) {
    const auto found = std::ranges::find(met_, met);
    const auto number = static_cast<uint32_t>(found - met_.begin());
    if (found == met_.end()) met_.push_back(met);
    return number;
  }

  void look_for_gain(const Vec3& direction) {
    for (size_t end = 0; end < ends_.size(); ++end) in_view_[end] = in_view_[end] || ends_[end].has_gain_toward(direction);
  }

  VisibilityFromEnd visibility_from(size_t end, const VisibilityGrid& grid) const {
    const std::vector<int64_t> numbers = grid.counts(met_.size());
    std::map<uint32_t, int64_t> counts;  // by surface
    int64_t num_found = 0;
    for (size_t number = 0; number < numbers.size(); ++number) {
      if (numbers[number] > 0) counts[met_[number][end]] += numbers[number];
      num_found += numbers[number];
    }
    VisibilityFromEnd seen;
    seen.in_view = num_found > 0 ? in_view_[end] : has_gain_toward_a_vertex(ends_[end]);
    const auto found = static_cast<double>(num_found);
    seen.solid_angle = found * grid.cell_angle();
    for (const auto& [surface, count] : counts) {
      const double share = static_cast<double>(count) / found;
      if (surface == object_) seen.visible_share = share;
      else seen.occluders.emplace_back(surfaces_.names[surface], share);
    }
    std::ranges::stable_sort(seen.occluders, std::greater(), [](const auto& occluder) { return occluder.second; });
    return seen;
  }

  bool has_gain_toward_a_vertex(const End& end) const {
    return std::any_of(views_.front().mesh_ids().begin(), views_.front().mesh_ids().end(), [&](uint32_t mesh) {
      const std::vector<Vec3>& vertices = geometry_.vertices(mesh);
      return std::ranges::any_of(vertices, [&](const Vec3& vertex) {
        return vertex != end.position && end.has_gain_toward((vertex - end.position).normalized());
      });
    });
  }

  const EmbreeScene& geometry_;
  const SurfaceMap& surfaces_;
  uint32_t object_;
  std::span<const End> ends_;
  std::vector<ObjectView> views_;  // [end]
  std::vector<Met> met_;
  std::array<bool, 2> in_view_{};
};

// Returns what both ends see of an object at these distances in m.
std::array<VisibilityFromEnd, 2> visibilities_of(const EmbreeScene& geometry, const SurfaceMap& surfaces, uint32_t object,
                                                 const std::array<End, 2>& ends, const std::array<double, 2>& distances,
                                                 int num_directions) {
  const double apart = (ends[1].position - ends[0].position).norm(), distance = std::min(distances[0], distances[1]);
  const bool are_near = apart <= kNearEnds * distance;
  ObjectScanner scanner(geometry, surfaces, object, std::span(ends).first(are_near ? 2 : 1));
  std::vector<VisibilityFromEnd> visibilities = scanner.visibilities(num_directions);
  const double seen = visibilities.front().solid_angle;
  if (are_near && apart * std::pow(scanner.extent(), 2) <= kSameOutline * seen * std::pow(distance, 3)) {
    if (apart > 0.0) visibilities[1].solid_angle *= std::pow(distances[0] / distances[1], 2);
  } else {
    visibilities.resize(1);
    visibilities.push_back(
        ObjectScanner(geometry, surfaces, object, std::span(ends).last(1)).visibilities(num_directions).front());
  }
  for (size_t end = 0; end < 2; ++end) visibilities[end].distance = distances[end];
  return {visibilities[0], visibilities[1]};
}

End end_of(const std::vector<Antenna>& antennas, const Transform& world_from_radar, const Vec3& origin) {
  return {mean_position(antennas, world_from_radar) - origin, posed_antennas(antennas, world_from_radar, origin)};
}

}  // namespace

std::vector<ObjectVisibility> visibility(const Scene& scene, const Radar& radar, const SurfaceMap& surfaces,
                                         const VisibilitySettings& settings, Job* job, KeptGeometry* kept) {
  radar.validate();
  require(settings.num_directions >= 1, "num_directions", "must be at least 1", settings.num_directions);
  const size_t num_meshes = surfaces.of_mesh.size();
  require(num_meshes == scene.meshes().size(), "surfaces", "must be of the scene, meshes", num_meshes);
  scene.require_times(settings.time, settings.time);
  const Transform world_from_radar = radar.world_from_radar(settings.time);
  const PosedScene pose(scene, settings.time);
  const Vec3 near = mean_position(radar.transmitters, world_from_radar);
  const GeometryLoan geometry(kept, scene, pose, near, EmbreeScene::upkeep_near(radar.is_moving()), job);
  const std::array<End, 2> ends = {end_of(radar.transmitters, world_from_radar, (*geometry).origin()),
                                   end_of(radar.receivers, world_from_radar, (*geometry).origin())};
  const NearestPoints nearest(scene, pose, *geometry);
  std::vector<ObjectVisibility> seen(surfaces.num_objects);
  if (job) job->start(surfaces.num_objects);
  parallel_for(surfaces.num_objects, [&](int64_t i) {
    const auto object = static_cast<uint32_t>(i);
    std::vector<uint32_t> mesh_ids = surfaces.meshes_of(object);
    const auto distances = nearest.distances({ends[0].position, ends[1].position}, mesh_ids);
    const auto visibilities = visibilities_of(*geometry, surfaces, object, ends, distances, settings.num_directions);
    seen[object] = {surfaces.names[object], std::move(mesh_ids), visibilities[0], visibilities[1]};
  }, job);
  return seen;
}

}  // namespace echopath
