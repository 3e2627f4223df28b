#pragma once
// Tells what the edges of planes leave of the field of an image at another time than that of the trace.
#include <complex>
#include <optional>

#include "echopath/replay/posed/local_paths.h"
#include "echopath/validity/legs/leg_shadows.h"

namespace echopath {

// Returns whether the path is an image over planes that nobody flagged: only these have edges (PlaneImages).
bool is_over_unflagged_planes(const LocalPath& path, const PathPreparer& preparer);

struct EdgeShare {
  std::complex<double> share;  // of the field of endless planes
  double slide = 0.0;  // half Fresnel zones by which a point of reflection has moved over its plane since the trace, at most
};

// Finds that for a path between two antennas; finds nothing where the path is not there. `hits` are its hits as they are
// posed, in the order of the trace. wavelength: m.
std::optional<EdgeShare> find_edge_share(const EmbreeScene& geometry, const LocalPath& path, const PosedHit* hits,
                                         const PosedAntenna& start, const PosedAntenna& end, double wavelength);

}  // namespace echopath
