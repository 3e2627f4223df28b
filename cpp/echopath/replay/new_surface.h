#pragma once
// Surface that the antennas see at some time of a frame and that was hidden from the trace: its echoes are in no record.
#include <vector>

#include "echopath/replay/instant.h"
#include "echopath/trace/embree_scene.h"

namespace echopath {

// Power of single echoes, each surface taken as rough: gains, |Gamma|^2, cosine and spreading of both ways; in units of their
// own, for shares.
struct SurfaceSeen {
  double power = 0.0;      // of all that is seen
  double hidden = 0.0;     // of what the trace could not see: in a shadow of its transmitter or receiver, or turned away
  std::vector<double> power_of, hidden_of;  // by object, the child of the scene's root above the mesh (node index)

  explicit SurfaceSeen(const Scene& scene) : power_of(scene.nodes().size()), hidden_of(scene.nodes().size()) {}
  void add(const SurfaceSeen& other);
};

// The two antennas of a trace and what it saw, m relative to the origin.
struct TraceView {
  const EmbreeScene& geometry;
  Vec3 transmitter, receiver;
};

// What `num_rays` rays from each of the transmitters of `antennas` find first in `geometry`, connected to each of the
// receivers; frequency in Hz. An independent test: it knows nothing of the record. The same bits for any number of threads.
// Raises Cancelled.
SurfaceSeen look_for_new_surface(const Scene& scene, double frequency, const Instant& antennas, const EmbreeScene& geometry,
                                 const TraceView& trace, int64_t num_rays, Job* job);

}  // namespace echopath
