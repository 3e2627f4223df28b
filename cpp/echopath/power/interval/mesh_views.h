#pragma once
// Tells over which flagged mirrors rays find the echoes of meshes of flat facets, and what bounds these echoes.
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "echopath/posed/posed_scene.h"
#include "echopath/power/interval/plane_rims.h"
#include "echopath/record/paths.h"

namespace echopath {

// Says which plane of a mesh a path meets, and in which view: over which mirrors it comes there and goes on.
struct PlaneInView {
  static constexpr uint32_t kNone = 0xFFFFFFFFu;
  uint32_t view = kNone;  // kNone: the path bounces off several meshes that are no mirrors, or off none
  uint32_t plane = 0;
  uint16_t stratum = 0;      // that aims at the mesh: of its ray, or the one in which that is a focus
  double solid_angle = 0.0;  // sr, for which the ray stands there; 0: the stratum does not aim at all of the mesh
};

// Holds the solid angle, sr, in which rays of each stratum that aims at all of a mesh have met each of its planes. Planes at
// the end may be missing.
using SeenPlanes = std::map<uint16_t, std::vector<double>>;

// Finds the views of the coherent paths of a record, which must outlive it.
class MeshViews {
 public:
  static constexpr size_t kMostTriangles = 4096;  // of meshes that are looked at: others and curved ones are not bounded

  // The wave goes from the first transmitter of `radar` to its first receiver.
  MeshViews(const Paths& paths, const Radar& radar);
  // Returns what a path of a ray meets that bounces off mirrors and the mesh `radiating` alone.
  PlaneInView of(int64_t path, uint32_t radiating);
  // Returns the most that the mesh sends on, 1/m, as if mirrored in full; infinite where rims do not bound that. Where no
  // stratum aims at all of it, a part of each plane may be hidden.
  double at_most(uint32_t view, const SeenPlanes& seen);

 private:
  struct View {
    const FacetedBody* body = nullptr;  // null where rims do not bound the echo
    AntennaPair antennas;               // or their images
    std::vector<Plane> before;          // the mirrors that the wave meets first
    std::map<uint16_t, bool> is_aimed;  // by index of the stratum, of those asked for: its rays go to all of the mesh
    std::vector<RimWaves> waves;        // of the planes, once they are asked for
  };
  // Holds the mesh that radiates, and the mirrors before and behind it, as planes of meshes.
  struct Key {
    uint32_t radiating = 0;
    bool is_reversed = false;
    std::vector<std::pair<uint32_t, uint32_t>> before, behind;
    auto operator<=>(const Key&) const = default;
  };

  const Hit& set_key(int64_t path, uint32_t radiating);
  uint32_t index_of_key();
  View found(const Key& key);
  bool aims_at(View& view, uint16_t stratum) const;
  Vec3 launch_direction(const View& view, const Vec3& point) const;
  double solid_angle(View& view, uint16_t of_ray, uint16_t owner, const Hit& met) const;
  const FacetedBody& posed(uint32_t mesh_id);
  std::vector<Plane> planes(const std::vector<std::pair<uint32_t, uint32_t>>& mirrors);

  const Paths& paths_;
  const double wavenumber_;  // rad/m
  AntennaPair antennas_;
  std::optional<PosedScene> scene_;
  std::map<uint16_t, std::vector<uint16_t>> foci_;  // by index of the stratum in which they are
  std::map<uint32_t, FacetedBody> bodies_;          // by mesh ID
  std::map<Key, uint32_t> index_;
  std::vector<View> views_;
  Key key_, last_;
  uint32_t last_index_ = PlaneInView::kNone;
};

}  // namespace echopath
