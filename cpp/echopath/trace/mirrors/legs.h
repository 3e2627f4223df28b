#pragma once
// Finds the legs between a surface point and an antenna: direct and over flagged mirrors.
#include <array>
#include <complex>
#include <span>

#include "echopath/em/surface/surface_response.h"
#include "echopath/trace/embree/embree_scene.h"
#include "echopath/trace/frusta/frustum_locator.h"

namespace echopath {

// Describes a bounce of a leg as a wave meets it that travels from the surface point to the antenna.
struct LegBounce {
  int mirror;  // index into the mirrors
  Hit hit;
  Vec3 direction;         // unit, of travel toward the mirror
  Vec3 normal;            // unit, on the lit side
  double specular_share;  // s_m^2
};

struct Leg {
  MirrorSequence sequence = kNoMirrors;
  int num_bounces = 0;
  std::array<LegBounce, kMaxLegMirrors> bounces;  // from the point toward the antenna
  double length = 0.0;                            // m, unfolded
  Vec3 to_antenna;                                // unit, from the point toward the antenna or its image
  Vec3 at_antenna;                                // unit, from the antenna toward the point or its image
  std::complex<double> gain = 1.0;                // field factor: product of Gamma_m s_m of the mirrors
  double specular_share = 1.0;  // product of s_m^2: the probability with which a ray goes on specularly over all of them

  Leg() {}  // so that a list of legs grows without touching bounces that are not there
};

struct AntennaView {
  Vec3 position;  // relative to the trace origin
  std::span<const MirrorFrustum> frusta;
  FrustumLocator locator;  // of the frusta
};

enum class ShadowState : uint8_t { kUnknown, kOpen, kBlocked };

// Says where legs are searched.
struct LegQuery {
  Vec3 point, normal;  // m; unit, on the lit side
  int max_mirrors = 0;
  MirrorSequence skip = -1;                    // a sequence that is left out, negative for none
  ShadowState direct = ShadowState::kUnknown;  // of the antenna itself
  bool faces_all = false;                      // legs leave to every side, from an edge that was lifted along the normal
};

// Holds what a search needs while it lasts; it is kept from search to search for its memory.
struct LegSearch {
  std::vector<Segment> segments;  // of all legs tried, in their order
  std::vector<uint8_t> blocked;
  int64_t num_queries = 0;  // of all searches
};

// Returns the view of an antenna by its frusta over at most kMaxLegMirrors mirrors each, which must outlive it.
AntennaView view_of(const Vec3& antenna, std::span<const MirrorFrustum> frusta);

class LegFinder {
 public:
  LegFinder(const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, double frequency, const Vec3& polarization);
  // Finds all visible legs between a point and `antenna`, the direct one first, then in the order of the frusta. The images
  // alone tell where a leg meets its mirrors; shadow queries, in packets, tell whether its way is free.
  void find(const LegQuery& query, const AntennaView& antenna, std::vector<Leg>& legs, LegSearch& search) const;

 private:
  void add_direct(const LegQuery& query, const AntennaView& antenna, std::vector<Leg>& legs, LegSearch& search) const;
  void add_over_mirrors(const LegQuery& query, const AntennaView& antenna, const MirrorFrustum& frustum,
                        std::vector<Leg>& legs, LegSearch& search) const;
  bool set_bounces(const Vec3& point, const Vec3& normal, const Vec3& antenna, const MirrorFrustum& frustum, Leg& leg,
                   std::vector<Segment>& segments) const;
  bool bounce(int mirror, const Vec3& from, const Vec3& image, Leg& leg, Vec3& met) const;
  void keep_open(size_t num_known, std::vector<Leg>& legs, LegSearch& search) const;
  void set_gain(Leg& leg) const;

  const EmbreeScene& geometry_;
  const std::vector<Mirror>& mirrors_;
  std::vector<SurfaceModel> models_;  // of the mirrors
  Vec3 polarization_;
};

}  // namespace echopath
