#pragma once
// Makes regions of a skinned mesh meshes of their own, which can be labelled.
#include "echopath/motion/skin.h"
#include "echopath/scene/readers/readers.h"

namespace echopath {

// Groups triangles by dominant joint (Skin::dominant_joint) and returns one mesh per joint that has any, named after the
// joint, in the order of the joints. All are parts of `mesh` and deform by `skin`. Raises invalid_argument unless the skin
// has the vertices that the mesh was made from.
std::vector<NamedMesh> parts_by_joint(const MeshPtr& mesh, const Skin& skin);

}  // namespace echopath
