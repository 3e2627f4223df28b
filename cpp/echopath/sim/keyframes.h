#pragma once
// A frame in several stretches of chirps, each with a record of its own time: where one trace does not serve the whole
// frame.
#include <vector>

#include "echopath/base/job.h"
#include "echopath/replay/posed/specular_slide.h"
#include "echopath/trace/geometry/kept_geometry.h"
#include "echopath/trace/record/paths.h"

namespace echopath {

enum class Retrace {
  kNever,    // one record serves the frame
  // Hits stay, shadow rays and points of reflection are renewed (validity/renewal.h), and new surface gets paths.
  kInvalid,
  // The scene is traced anew with the same rays. Phases of rough surfaces then belong to rays and not to the surface, so
  // that their echoes have wrong Doppler: a reference for coherent echoes.
  kAlways,
};

struct KeyframeSettings {
  Retrace retrace = Retrace::kNever;
  int keyframes = 0;  // stretches of the frame, 1 to num_chirps; 0: what validity asks for
};

struct Stretch {
  int first_chirp = 0;
  double start_time = 0.0;  // s
  double middle = 0.0;      // s, the time of its record
  Radar radar;              // with the chirps of the stretch
};

// `count` stretches of nearly equal length. Raises invalid_argument unless 1 <= count <= num_chirps.
std::vector<Stretch> stretches_of(const Radar& radar, double start_time, int count);

// The number of stretches to use: that of the settings, or what validity asks for (Validity::keyframes).
int num_keyframes(const Paths& paths, const Radar& radar, const KeyframeSettings& settings,
                  SpecularPoints specular = SpecularPoints::kMaterial, Job* job = nullptr);

// The records of the stretches of a frame. Their frames start with the stretch.
class StretchRecords {
 public:
  // For kInvalid and a whole record of a scene in which something moves, it looks for new surface in the middle of up to kMostLooks
  // stretches, with as many rays as the record has: what neither the trace nor a look before could have had is a record of its own,
  // with phases of its own. So each piece of surface stands in one of the records, the same material points with the same phases
  // throughout. All must outlive it; a selection of paths gets no new surface. Raises invalid_argument for kAlways with a selection.
  StretchRecords(const Paths& paths, const Radar& radar, const std::vector<Stretch>& stretches, Retrace retrace, Job* job = nullptr);
  // Records whose echoes add up to those of the stretch, at least one.
  std::vector<Paths> of(const Stretch& stretch);

 private:
  void find_new_surface(const Radar& radar, const std::vector<Stretch>& stretches);

  const Paths& paths_;
  Retrace retrace_;
  Job* job_;
  KeptGeometry kept_;
  std::vector<Paths> found_;  // by the looks
};
inline constexpr int kMostLooks = 32;

}  // namespace echopath
