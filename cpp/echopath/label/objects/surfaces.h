#pragma once
// Names the objects of a scene and the surfaces around them that mirror or hide them. Labels tell echoes apart by these
// names.
#include <cstdint>
#include <string>
#include <vector>

#include "echopath/record/paths.h"

namespace echopath {

struct NamedGlobs {
  std::string name;
  std::vector<std::string> globs;  // takes the meshes that any of them takes (scene.h: glob_takes)
};

// Assigns each mesh to one object or to one other surface.
//
// A surface is the highest group above a mesh that holds no object and at most one flagged mirror: as a rule the child of
// the scene's root, but each wall of a street on its own, because each mirror makes an image of its own.
struct SurfaceMap {
  std::vector<std::string> names;  // of the objects, in order, then of the other surfaces by their first mesh
  uint32_t num_objects = 0;
  std::vector<uint32_t> of_mesh;  // [M] index into names

  bool is_object(uint32_t surface) const { return surface < num_objects; }
  std::vector<uint32_t> meshes_of(uint32_t surface) const;
};

// Gives each mesh to the first object that takes it. Raises invalid_argument for names that are empty or given twice, for a
// glob that takes no mesh (naming the nearest names) and for an object that those before it leave without a mesh. Objects
// whose meshes do not take part are left out.
SurfaceMap map_surfaces(const Scene& scene, const std::vector<NamedGlobs>& objects);

// Takes the objects that rays are aimed at: children of the root, without their flagged mirrors, that do not surround
// `antenna` (world) at `time` (s); in the order of the scene. An object whose bounding sphere holds the antenna surrounds it
// where the box along its principal axes, half a metre wider, holds the antenna too, as those of a tunnel and of the radar's
// own vehicle do, or where it is flat (the smallest side of that box is at most a tenth of the middle one), as a wall or a
// road. What lies wholly ahead of the antenna, along the unit vector `ahead` (world; zero: it looks all around), is no
// vehicle of the radar but what it looks at, as a person half a metre away, unless it is flat. What is not there at `time`
// (Node::lifetime) surrounds nothing.
SurfaceMap map_surfaces(const Scene& scene, double time, const Vec3& antenna, const Vec3& ahead = Vec3::Zero());

// Does the same for a radar, by the mean position and boresight of its transmitters at `time` (s).
SurfaceMap map_surfaces(const Scene& scene, double time, const Radar& radar);

// Does the same for a record, as its frame says: at objects_time.
SurfaceMap map_surfaces(const Paths& paths);

}  // namespace echopath
