#pragma once
// Remembers where the geometry of a scene's traces is kept, for those who hold only a record.
#include <memory>

#include "echopath/scene/scene.h"
#include "echopath/trace/embree/kept_geometry.h"

namespace echopath::bindings {

// The geometry is that of the trace whose record holds the scene `snapshot`. Neither is kept alive. Thread-safe.
void remember_geometry(const std::shared_ptr<const Scene>& snapshot, const std::shared_ptr<KeptGeometry>& kept);
// Returns null where it is not known or no longer there.
std::shared_ptr<KeptGeometry> geometry_of(const std::shared_ptr<const Scene>& snapshot);

}  // namespace echopath::bindings
