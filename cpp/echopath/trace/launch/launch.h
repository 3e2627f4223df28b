#pragma once
// Plans where rays start: strata of directions and the low-discrepancy set inside each.
#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "echopath/record/stratum.h"
#include "echopath/trace/embree/packet.h"
#include "echopath/trace/frusta/mirror_frusta.h"
#include "echopath/trace/launch/launch_focus.h"
#include "echopath/trace/launch/launch_points.h"
#include "echopath/trace/scatter/surface_points.h"
#include "echopath/trace/strata/fitted_strata.h"
#include "echopath/trace/strata/ray_owners.h"

namespace echopath {

// Distributes the rays of a launch over strata of directions. `strata` holds first one stratum for each object, fitted to
// its outline as seen from the transmitter (fit_stratum.h), then one for each image of an object over mirrors, then the foci
// that a guide may set into these strata (launch_focus.h), and last the antenna's field of view. Objects are the children of
// the scene's root, without their mirrors. Where one surrounds the transmitter, as a town does, or is a group of things that
// stand apart, these take its place (ray_targets.h).
//
// Each stratum counts the echoes that it owns (ray_owners.h). The field of view owns the echoes of objects that surround the
// transmitter, of objects and images without a stratum of their own, and the diffuse echoes of mirrors. It gets 15 % of the
// rays where it owns anything; the others are aimed. By default, moving objects get at least half of the aimed rays, or half
// of them in all frames (LaunchSettings::is_steady). Apart from that, objects and images over one mirror get equal shares,
// and images over two mirrors a quarter of such a share; the things of one object share what it would get. A stratum that
// would get fewer than kFewestRays rays is left out. LaunchSettings::by_object has another rule.
struct LaunchPlan {
  static constexpr int64_t kFewestRays = 4;

  // Holds what belongs to each of a packet's rays.
  struct Places {
    std::array<int, kPacketSize> strata, batches;
    LaneValues x, y;  // of the stratum's lattice
  };

  std::vector<Stratum> strata;
  std::vector<std::unique_ptr<const LaunchPoints>> points;  // of each stratum
  std::vector<int64_t> first_ray;                           // [strata + 1] running sum of num_rays
  // [strata] where the random numbers of their rays begin, so that packets have rays of one stratum; empty: each ray has the
  // numbers of its index.
  std::vector<int64_t> first_number;
  RayOwners owners;
  LaunchFoci foci;
  uint64_t seed = 0;
  int batches = 1;
  int64_t num_unaimed = 0;  // objects and images that have no stratum of their own because there are too many of them
  // [strata] rays per sr by the rule of shares, whatever the guide says: of all rays, or where they are steady for what
  // stands still of twice its own.
  std::vector<double> default_density;
  // Where rough surfaces have scatterers of their own (TraceSettings::scatterers), rays are aimed at these, too. They then
  // make all diffuse echoes of first hits straight from the transmitter, and the rays above make all other echoes. The ray
  // of the first of these points has this index, behind those of the strata and a multiple of kPacketSize.
  int64_t first_point = 0;
  std::vector<SurfacePoint> surface_scatterers;

  bool has_surface_scatterers() const { return !surface_scatterers.empty(); }
  bool is_aimed_at_scatterer(int64_t ray) const { return has_surface_scatterers() && ray >= first_point; }

  int stratum_of(int64_t ray) const;
  // Returns the index of a ray of a stratum in the random numbers.
  int64_t number_of(int64_t ray) const;
  // Returns the bounds of pieces of at most `size` rays of one stratum each, and then of the scatterers that are aimed at.
  std::vector<std::pair<int64_t, int64_t>> pieces(int64_t size) const;
  int batch_of(int stratum, int64_t ray) const;
  // Returns the rays per sr inside the stratum, of all batches together; the next function those of one batch.
  double density(int stratum) const { return strata[stratum].ray_density; }
  double lattice_density(int stratum) const { return density(stratum) / batches; }
  Eigen::Vector2d point_of(int stratum, int64_t ray) const;
  // Finds the places of `count` rays in a row.
  void place(int64_t begin, int count, Places& out) const;
  // Returns whether the stratum is the field of view, or a focus in it.
  bool is_field_of_view(int stratum) const { return foci.owner(stratum) == owners.field_of_view(); }
};

struct LaunchSettings {
  int64_t num_rays = 0;
  uint64_t seed = 0;
  Sampler sampler = Sampler::kLattice;
  int batches = 1;                        // independent shifts of the set of each stratum, which share its rays
  std::span<const MirrorFrustum> frusta;  // of the transmitter; images over these get strata
  Vec3 transmitter = Vec3::Zero();
  Vec3 boresight = Vec3::UnitX();
  double field_versine = 2.0;  // 1 - cosine of the field of view's half angle
  LaunchGuide guide;           // by default the rule above, without foci
  // The rule is that of rays_by_object, for scenes that are edited: the rays of an object depend little on what else is in
  // the scene.
  bool by_object = false;
  // Rays have random numbers by the name of their stratum, shares are rounded to whole rays one by one, and those of a guide
  // count rays: a stratum that stands still and gets the same share in another plan has the same rays there.
  bool by_name = false;
  // What stands still has the same share in all frames, half of the rays that are aimed (has_steady_rays): by name.
  bool is_steady = false;
  FittedStrata* fitted = nullptr;  // RayTargetSettings::fitted
  const Job* job = nullptr;        // RayTargetSettings::job
};

// Raises Cancelled when the job of the settings is.
LaunchPlan plan_launch(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                       const LaunchSettings& settings);

}  // namespace echopath
