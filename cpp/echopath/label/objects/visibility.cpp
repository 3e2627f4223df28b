#include "echopath/label/objects/visibility.h"

#include <algorithm>
#include <optional>

#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/label/objects/nearest_point.h"
#include "echopath/label/objects/object_view.h"
#include "echopath/label/objects/sight_grid.h"
#include "echopath/trace/embree/kept_geometry.h"

namespace echopath {
namespace {

constexpr int kGridCells = 2;                          // for each direction asked for, at first
constexpr double kLeastFill = 0.25;                    // share of cells on the object below which there are to be more
constexpr double kLooseFill = 0.2;                     // below which the stratum is fitted to the vertices
constexpr double kMostCells = 16.0;                    // for each direction asked for
constexpr int kFewerIfHidden = 16, kLeastCells = 256;  // cells of a grid that serves the solid angle alone

// Holds the antennas of one end of the radar.
struct End {
  Vec3 position;  // mean, relative to the origin
  std::vector<PosedAntenna> antennas;

  bool has_gain_toward(const Vec3& direction) const {
    return std::any_of(antennas.begin(), antennas.end(),
                       [&](const PosedAntenna& antenna) { return antenna.toward(direction).power > 0.0; });
  }
};

// Finds what hides one object from one end.
class ObjectScanner {
 public:
  ObjectScanner(const EmbreeScene& geometry, const SurfaceMap& surfaces, uint32_t object, const End& end)
      : geometry_(geometry), surfaces_(surfaces), object_(object), end_(end),
        view_(geometry, surfaces, object, end.position) {}

  Sight sight(int num_directions) {
    const SightGrid::FindMet find_met = [this](const LaneVectors& directions, int count, uint32_t* met) {
      see(directions, count, met);
    };
    const Stratum stratum = view_.stratum(false);
    if (const std::optional<uint32_t> hiding = hidden_by(stratum, num_directions)) {
      return hidden_sight(stratum, *hiding, num_directions);
    }
    const SightGrid grid = looked_at(stratum, num_directions, find_met);
    return sight_of(grid.counts(surfaces_.names.size()), grid.cell_angle());
  }

 private:
  // Returns the surface that hides the object wherever it is: one that is met before its boxes in one direction of each
  // block of a grid.
  std::optional<uint32_t> hidden_by(const Stratum& stratum, int num_directions) const {
    uint32_t hiding = ObjectView::kNothing;
    SightGrid grid(stratum, int64_t{kGridCells} * num_directions);
    grid.start([&](const LaneVectors& directions, int count, uint32_t* met) {
      std::fill_n(met, count, SightGrid::kNothing);
      if (hiding == ObjectView::kSeveral) return;
      const uint32_t here = view_.only_hiding(directions, count);
      if (hiding == ObjectView::kNothing) hiding = here;
      if (here != ObjectView::kNothing && here != hiding) hiding = ObjectView::kSeveral;
    });
    const bool is_one = hiding != ObjectView::kNothing && hiding != ObjectView::kSeveral;
    return is_one ? std::optional<uint32_t>(hiding) : std::nullopt;
  }

  // Looks only for the solid angle of an object that `hiding` hides.
  Sight hidden_sight(const Stratum& stratum, uint32_t hiding, int num_directions) {
    SightGrid grid(stratum, std::max(kLeastCells, num_directions / kFewerIfHidden));
    grid.finish_everywhere([&](const LaneVectors& directions, int count, uint32_t* met) {
      view_.look_for(directions, count, met);
      for (int lane = 0; lane < count; ++lane) {
        if (met[lane] == SightGrid::kNothing) continue;
        met[lane] = hiding;
        in_view_ = in_view_ || end_.has_gain_toward(directions[lane]);
      }
    });
    return sight_of(grid.counts(surfaces_.names.size()), grid.cell_angle());
  }

  // Looks at as many cells as it takes to have so many directions on the object.
  static SightGrid looked_at(const Stratum& stratum, double fill, int num_directions, const SightGrid::FindMet& find_met) {
    const double cells = fill > 0.0 ? std::min(kMostCells, 1.0 / fill) : kMostCells;
    SightGrid grid(stratum, static_cast<int64_t>(cells * num_directions));
    if (grid.start(find_met) > 0.0) grid.finish(find_met);
    else grid.finish_everywhere(find_met);
    return grid;
  }

  SightGrid looked_at(Stratum stratum, int num_directions, const SightGrid::FindMet& find_met) const {
    SightGrid grid(stratum, int64_t{kGridCells} * num_directions);
    double fill = grid.start(find_met);
    if (fill < kLooseFill) {
      stratum = view_.stratum(true);
      grid = SightGrid(stratum, int64_t{kGridCells} * num_directions);
      fill = grid.start(find_met);
    }
    if (fill < kLeastFill) return looked_at(stratum, fill, num_directions, find_met);
    grid.finish(find_met);
    return grid;
  }

  void see(const LaneVectors& directions, int count, uint32_t* met) {
    ObjectView::Seen seen;
    view_.look(directions, count, seen);
    std::copy_n(seen.surface.begin(), count, met);
    for (int lane = 0; !in_view_ && lane < count; ++lane) {
      in_view_ = met[lane] != SightGrid::kNothing && end_.has_gain_toward(directions[lane]);
    }
  }

  Sight sight_of(const std::vector<int64_t>& counts, double solid_angle_each) const {
    int64_t num_found = 0;
    for (const int64_t count : counts) num_found += count;
    Sight sight;
    sight.in_view = num_found > 0 ? in_view_ : has_gain_toward_a_vertex();
    if (num_found == 0) return sight;
    const auto found = static_cast<double>(num_found);
    sight.solid_angle = found * solid_angle_each;
    sight.visible_share = static_cast<double>(counts[object_]) / found;
    for (size_t i = 0; i < counts.size(); ++i) {
      const auto hidden = static_cast<double>(counts[i]);
      if (i != object_ && hidden > 0) sight.occluders.emplace_back(surfaces_.names[i], hidden / found);
    }
    std::stable_sort(sight.occluders.begin(), sight.occluders.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    return sight;
  }

  bool has_gain_toward_a_vertex() const {
    return std::any_of(view_.mesh_ids().begin(), view_.mesh_ids().end(), [&](uint32_t mesh) {
      const std::vector<Vec3>& vertices = geometry_.vertices(mesh);
      return std::any_of(vertices.begin(), vertices.end(), [&](const Vec3& vertex) {
        return vertex != end_.position && end_.has_gain_toward((vertex - end_.position).normalized());
      });
    });
  }

  const EmbreeScene& geometry_;
  const SurfaceMap& surfaces_;
  uint32_t object_;
  const End& end_;
  ObjectView view_;
  bool in_view_ = false;
};

std::vector<uint32_t> meshes_of_objects(const SurfaceMap& surfaces) {
  std::vector<uint32_t> meshes;
  for (uint32_t mesh = 0; mesh < surfaces.of_mesh.size(); ++mesh) {
    if (surfaces.is_object(surfaces.of_mesh[mesh])) meshes.push_back(mesh);
  }
  return meshes;
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
  const GeometryLoan geometry(kept, scene, pose, near, radar.motion != nullptr, job);
  const std::array<End, 2> ends = {end_of(radar.transmitters, world_from_radar, (*geometry).origin()),
                                   end_of(radar.receivers, world_from_radar, (*geometry).origin())};
  const NearestPoints nearest(scene, pose, *geometry, meshes_of_objects(surfaces));
  std::vector<ObjectVisibility> seen(surfaces.num_objects);
  if (job) job->start(surfaces.num_objects);
  parallel_for(surfaces.num_objects, [&](int64_t i) {
    const auto object = static_cast<uint32_t>(i);
    const auto distances = nearest.distances({ends[0].position, ends[1].position}, surfaces.meshes_of(object));
    const auto from = [&](size_t end) {
      Sight sight = ObjectScanner(*geometry, surfaces, object, ends[end]).sight(settings.num_directions);
      sight.distance = distances[end];
      return sight;
    };
    seen[object] = {surfaces.names[object], from(0), from(1)};
  }, job);
  return seen;
}

}  // namespace echopath
