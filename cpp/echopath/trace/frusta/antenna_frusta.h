#pragma once
// Finds what both antennas light over flagged mirrors, once for all that ask for it: aims at images, legs, and paths over
// mirrors alone.
#include <span>

#include "echopath/base/threads/job.h"
#include "echopath/scene/scene.h"
#include "echopath/trace/frusta/mirror_frusta.h"
#include "echopath/trace/sbr/sbr_settings.h"

namespace echopath {

struct AntennaFrusta {
  MirrorFrusta transmitter, receiver;
  bool serve_legs = false;  // some surface sends echoes to the antennas by itself, so that legs may go over the mirrors
  bool receiver_is_longer = false;  // for the longest paths, over an odd number of mirrors, most of these are the receiver's

  int64_t num_unfollowed() const { return transmitter.num_unfollowed + receiver.num_unfollowed; }
};

// Returns the most mirrors between a surface point and an antenna.
int most_leg_mirrors(const SbrSettings& settings);

// Returns the frusta over as many mirrors as paths over mirrors alone need, whose search begins at both ends
// (mirror_paths.h), and where any surface radiates also as many as legs need. Where all surfaces are flagged mirrors that
// scatter nothing, there are no legs. Where one end needs a mirror more than the other, and legs do not, it is the end with
// fewer frusta. Those whose last mirror lies behind surfaces that cast shadows are left out. Raises Cancelled when the job
// is cancelled.
AntennaFrusta find_antenna_frusta(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                                  const SbrSettings& settings, const ShadowCasters& casters, const Job* job);

// Returns those over at most `max_mirrors` mirrors.
std::span<const MirrorFrustum> with_at_most(const MirrorFrusta& found, int max_mirrors);

}  // namespace echopath
