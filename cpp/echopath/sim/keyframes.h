#pragma once
// A frame in several stretches of chirps, each with a record of its own time: where one trace does not serve the whole
// frame.
#include <vector>

#include "echopath/base/job.h"
#include "echopath/replay/specular_slide.h"
#include "echopath/trace/kept_geometry.h"

namespace echopath {

enum class Retrace {
  kNever,    // one record serves the frame
  kInvalid,  // hits stay, shadow rays and points of reflection are renewed (replay/renewal.h)
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

// The number of stretches to use: that of the settings, or what validity suggests for moving points of reflection, and
// kOcclusionKeyframes at least where more of the power than kValidityLimit is blocked or comes into view.
int num_keyframes(const Paths& paths, const Radar& radar, const KeyframeSettings& settings,
                  SpecularPoints specular = SpecularPoints::kMaterial, Job* job = nullptr);
inline constexpr int kOcclusionKeyframes = 8;

// The record of a stretch. Its frame starts with the stretch. Raises invalid_argument for kAlways with a selection of paths.
// `kept`: geometry that goes from stretch to stretch.
Paths record_of(const Paths& paths, const Stretch& stretch, Retrace retrace, Job* job = nullptr,
                KeptGeometry* kept = nullptr);

}  // namespace echopath
