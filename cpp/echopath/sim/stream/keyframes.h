#pragma once
// Splits a frame into stretches of chirps, each with a record of its own time, where one trace does not serve the whole
// frame.
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/record/paths.h"
#include "echopath/replay/posed/specular_slide.h"
#include "echopath/trace/embree/kept_geometry.h"
#include "echopath/trace/mirrors/plane_doubles.h"

namespace echopath {

enum class Retrace {
  kNever,  // one record serves the frame
  // Hits stay, what became of the legs between them is renewed (validity/renewal.h), and new surface gets paths.
  kInvalid,
  // The scene is traced anew with the same rays. Unless scatterers are those of the surface (record/scatterers.h),
  // phases of rough surfaces then belong to rays, so that their echoes have wrong Doppler: a reference for coherent echoes.
  kAlways,
};

struct KeyframeSettings {
  Retrace retrace = Retrace::kNever;
  int keyframes = 0;  // stretches of the frame, 1 to num_chirps; 0: as many as validity asks for
};

struct Stretch {
  int first_chirp = 0;
  double start_time = 0.0;  // s
  double middle = 0.0;      // s, the time of its record
  Radar radar;              // with the chirps of the stretch
};

// Returns `count` stretches of nearly equal length. Raises invalid_argument unless 1 <= count <= num_chirps.
std::vector<Stretch> stretches_of(const Radar& radar, double start_time, int count);

// Returns the number of stretches to use: that of the settings, or what validity asks for (Validity::keyframes).
int num_keyframes(const Paths& paths, const Radar& radar, const KeyframeSettings& settings, SpecularPoints specular,
                  Job* job);

// Makes the records of the stretches of a frame. The frame of a record starts with its stretch.
class StretchRecords {
 public:
  // For kInvalid and a whole record of a scene in which something moves, it looks for new surface in the middle of up to
  // kMaxSurfaceSearches stretches, with as many rays as the record has. Paths that neither the trace nor an earlier look
  // could have found become a record with phases of its own. So each piece of surface stands in one of the records, with the
  // same material points and phases throughout. Where the trace or a look has an image over a plane that nobody flagged,
  // the paths of rays over that plane take its place while it is not there, and are left out while it is. All arguments must
  // outlive it; a selection of paths gets no new surface. Raises invalid_argument for kAlways with a selection.
  StretchRecords(const Paths& paths, const Radar& radar, const std::vector<Stretch>& stretches, Retrace retrace,
                 Job* job = nullptr);
  // Returns records, at least one, whose echoes add up to those of the stretch.
  std::vector<Paths> of(const Stretch& stretch);

 private:
  // Holds paths on new surface: those of rays, the others, and which paths of rays these stand for.
  struct Found {
    Paths of_rays, others;
    PlaneDoubles doubles;
  };
  struct Look {
    double time;  // s
    PlaneDoubles doubles;
  };

  void find_new_surface(const Radar& radar, const std::vector<Stretch>& stretches);
  Found parted(const Paths& found, const PlaneDoubles& doubles) const;
  void take_out(const Look& look, const Radar& radar, Paths& found, KeptGeometry& kept) const;
  Paths renewed(const Paths& paths, const Stretch& stretch);

  const Paths& paths_;
  Retrace retrace_;
  Job* job_;
  KeptGeometry kept_;
  PlaneDoubles own_doubles_;  // of the images of the record
  std::vector<Found> found_;
};
inline constexpr int kMaxSurfaceSearches = 32;

}  // namespace echopath
