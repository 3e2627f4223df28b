#pragma once
// Shooting and bouncing one ray: both transport regimes, a connection to the receiver at every hit.
//
// Regime C (coherent): the ray carries a field, and each unflagged hit radiates by physical optics over every visible
// receive leg. Regime D (diffuse): the ray carries power with one random phase per diffuse hit. A diffuse hit that the ray
// reached directly or over at most kMaxLegMirrors flagged mirrors is paired with all its visible transmit and receive legs,
// under the balance weight over the ways in which rays could have found it. A ray counts what its stratum owns (ray_owners.h):
// one that was aimed at an object goes over flagged mirrors as they reflect, without chance, and ends at whatever else it meets
// first. Flagged mirrors radiate diffusely only, by rays of the field of view; paths over mirrors alone come from
// mirror_paths.h. A chain of diffuse hits gives both of its orders, with one phase, under the balance weight over the rays that
// meet it from either end (sbr_diffuse.cpp).
// A specular bounce off an unflagged surface is geometrical optics, which holds where the surface covers the Fresnel zone
// (mirror_zone.h). What counts is the surface around the point, over whatever meshes it is spread; the edges of one narrower
// than the zone take their part of the field. Of the two orders of a coherent path the better one stands (sbr_orders.cpp): the
// one whose mirrors cover more of their zones, and whose rays lie denser. In its place the other one gives its reversal. A
// diffuse echo behind a mirror that covers too little is dropped; elsewhere it gives its reversal, which no ray finds.
// Sources: Ling, Chou, Lee 1989 (SBR); Degli-Esposti et al. 2007 (effective roughness); Veach 1997 (balance heuristic).
#include "echopath/trace/chance.h"
#include "echopath/trace/launch.h"
#include "echopath/trace/launch_directions.h"
#include "echopath/trace/legs.h"
#include "echopath/trace/mirror_zone.h"
#include "echopath/trace/path_block.h"

namespace echopath {

struct SbrSettings {
  int max_bounces = 4;
  uint64_t seed = 0;
  double frequency = 77e9;                   // Hz
  Vec3 transmitter = Vec3::Zero();           // relative to the trace origin, as the receiver
  Vec3 receiver = Vec3::Zero();
  bool is_polarized = false;                 // follow field vectors (PolarizationModel::kJones)
  Vec3 polarization = Vec3::UnitZ();         // transmit polarisation, unit, world axes
  // Of going on specularly where a surface does both; 0: its specular share, and any other leaves the expected echo as it is.
  double specular_probability = 0.0;
};

class RayShooter {
 public:
  RayShooter(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, const LaunchPlan& plan,
             const SbrSettings& settings);
  // Traces the rays [begin, end) of the plan and appends their paths. Thread-safe for different blocks.
  void shoot(int64_t begin, int64_t end, PathBlock& block) const;
  // Of the antennas' beams over mirrors, those whose further mirrors were not looked for (kMostBeams).
  int64_t num_unfollowed_beams() const { return transmitter_.num_unfollowed + receiver_.num_unfollowed; }

 private:
  struct Ray;      // what the ray carries
  struct Surface;  // where it is
  struct RayAtHit;
  struct Scratch;
  struct LobeProbabilities {    // of going on
    double specular = 0.0, diffuse = 0.0;
  };
  static constexpr LobeProbabilities kPassingOn{1.0, 0.0};  // of rays that are not yet where they aim at
  struct Packet;   // of neighbouring rays up to their first hits
  struct ScatterSample;  // of a ray from a hit
  struct Chain;    // of diffuse hits
  struct PathEnd;
  struct OrderShares {  // of a ray's echo, in its own order and in the opposite one
    double own = 1.0, opposite = 0.0;
  };
  struct ModesIn;  // of a wave at a hit, where polarised
  struct AxesOut;  // likewise, of a receiver
  using RayHits = std::array<Hit, 64>;

  // sbr_packet.cpp: to the first hits, and from there as far as it can be told lane by lane.
  void shoot_packet(Packet& packet, Scratch& scratch, PathBlock& block) const;
  void launch_packet(Packet& packet) const;
  void arrive_packet(Packet& packet, PathBlock& block) const;
  void look_at_surface(Packet& packet, int lane) const;
  void look_at_modes(Packet& packet, int lane) const;
  void look_at_receiver(Packet& packet, PathBlock& block) const;
  void shoot_lane(const Packet& packet, int lane, Scratch& scratch, PathBlock& block) const;
  void add_echoes(const Packet& packet, int lane, PathBlock& block) const;
  static ScatterSample sample_of(const Packet& packet, int lane);
  RayAtHit& start(const Packet& packet, int lane, Scratch& scratch) const;
  // One ray.
  void follow(Ray& ray, Surface& surface, Scratch& scratch, PathBlock& block) const;
  EmbreeScene::Verdict ask(const Vec3& from, const Vec3& direction, RayHit& met, PathBlock& block) const;
  bool travel(Ray& ray, const ScatterSample& sample, const RayHit& met, Surface& surface, Scratch& scratch, PathBlock& block) const;
  bool arrive(Ray& ray, Surface& surface, const Scratch& scratch, PathBlock& block) const;
  bool is_owner(int stratum, uint32_t mesh_id, MirrorSequence sequence) const;
  bool passes(int stratum, uint32_t mesh_id) const;
  void record_hit(Ray& ray, Surface& surface) const;
  void follow_tube(Ray& ray, Surface& surface) const;
  std::array<float, 7> cell_behind_curves(const Ray& ray, const Surface& surface) const;
  // sbr_orders.cpp: unflagged surfaces as mirrors, and which of a path's two orders stands.
  double width_of_smooth(uint32_t mesh_id) const;
  ZoneCover cover_of(const MirrorView& view, const ZoneTarget* target, PathBlock& block) const;
  PathEnd end_at(const MirrorView& view, const ZoneCover& cover) const;
  void look_at_mirror(Ray& ray, const Surface& surface, const Scratch& scratch, PathBlock& block) const;
  OrderShares shares_of_orders(const Ray& ray, const Surface& surface, const Leg& leg, PathBlock& block) const;
  double resolution_of(const Ray& ray, const Surface& surface, const Leg& leg, const PathEnd& last) const;
  void record(const Ray& ray, const Surface& surface, const Leg& leg, uint64_t bits, std::complex<double> weight,
              const OrderShares& shares, const Scratch& scratch, PathBlock& block) const;
  static RayHits way_back_over(const Ray& ray, const Leg& leg);
  void set_columns(const Ray& ray, const Surface& surface, const Leg& leg, uint64_t bits, const Scratch& scratch,
                   PathBlock& block) const;
  void connect(const Ray& ray, const Surface& surface, Scratch& scratch, PathBlock& block) const;
  void connect_coherent(const Ray& ray, const Surface& surface, const Scratch& scratch, PathBlock& block) const;
  void connect_diffuse(const Ray& ray, const Surface& surface, const Scratch& scratch, PathBlock& block) const;
  void connect_all_pairs(const Ray& ray, const Surface& surface, Scratch& scratch, PathBlock& block) const;
  LegQuery legs_from(const Surface& surface, int max_mirrors, MirrorSequence skip) const;
  double density_over(uint32_t mesh_id, const Leg& leg) const;
  double material_area(const Ray& ray, const Surface& surface, const std::vector<Leg>& others) const;
  void record_fan(const Ray& ray, const Surface& surface, std::complex<double> weight, Scratch& scratch,
                  PathBlock& block) const;
  // sbr_bounce.cpp
  ScatterSample scatter(const Ray& ray, const Surface& surface, const Chain& chain, int batch) const;
  bool bounce(Ray& ray, const Surface& surface, const ScatterSample& sample, Scratch& scratch) const;
  void bounce_specular(Ray& ray, const Surface& surface, const ScatterSample& sample, Scratch& scratch) const;
  void reflect_tube(Ray& ray, const Surface& surface) const;
  void bounce_diffuse(Ray& ray, const Surface& surface, const ScatterSample& sample, Scratch& scratch) const;
  Vec3 scatter_lobe(const Ray& ray, int batch) const;
  LobeProbabilities odds_of(const SurfaceModel& model, const SurfaceResponse& response) const;
  static double survival_of(const SurfaceResponse& response, int num_bounces);  // of the roulette behind that many bounces
  SurfaceResponse response_toward(const Surface& surface, const Vec3& direction) const;
  // sbr_diffuse.cpp: chains of several diffuse hits.
  void begin_chain(const Ray& ray, const Surface& surface, double probability, Scratch& scratch) const;
  void leave_diffuse(const Ray& ray, const Surface& surface, const Vec3& out, double probability, Chain& chain) const;
  void leave_specular(const Ray& ray, const Surface& surface, double probability, Chain& chain) const;
  void find_transmit_legs(const Surface& surface, int max_mirrors, MirrorSequence skip, Scratch& scratch) const;
  void connect_chain(const Ray& ray, const Surface& surface, Scratch& scratch, PathBlock& block) const;
  double share_of_order(const Surface& surface, const SurfaceResponse& response, const Leg& leg, const Chain& chain) const;
  void record_reversed(const Ray& ray, const Chain& chain, const Leg& leg, uint64_t bits, std::complex<double> weight,
                       PathBlock& block) const;
  // sbr_polarization.cpp: only where polarised.
  void reflect_polarized(const Ray& ray, const Surface& surface, FieldPair& fields) const;
  JonesMatrix coherent_matrix(const Ray& ray, const Surface& surface, const Leg& leg, const FieldPair& axes) const;
  JonesMatrix diffuse_matrix(const Ray& ray, const Surface& surface, const Leg& leg, const FieldPair& axes) const;
  void find_receive_axes(Scratch& scratch) const;
  void add_pair_matrices(const Ray& ray, const Surface& surface, Scratch& scratch, PathBlock& block) const;
  ModesIn modes_in(const Surface& surface, const Vec3& arrival, const FieldPair& fields, double diffuse) const;
  void scatter_polarized(Ray& ray, const Surface& surface, const Vec3& out) const;
  FieldPair scattered(const Surface& surface, const FieldPair& fields, const Vec3& in, const Vec3& out) const;
  FieldPair scattered_back(const Surface& surface, const FieldPair& fields, const Vec3& in,
                           const Vec3& out) const;
  JonesMatrix opposite_matrix(const Ray& ray, const Surface& surface, const Leg& leg, const Chain& chain) const;
  FieldPair incident_over(const Leg& leg) const;
  FieldPair fields_over(const Leg& leg, FieldPair fields) const;
  FieldPair axes_over(const Leg& leg) const;

  const Scene& scene_;
  const EmbreeScene& geometry_;
  const std::vector<Mirror>& mirrors_;
  const LaunchPlan& plan_;
  LaunchDirections directions_;
  SbrSettings settings_;
  LegFinder legs_;
  AntennaView transmitter_, receiver_;
  std::vector<int> mirror_of_mesh_;  // by mesh ID, -1: none
  std::vector<SurfaceModel> models_;  // by mesh ID
  std::vector<LobeProbabilities> constant_odds_;   // by mesh ID, of models that are constant
  std::vector<double> mesh_width_;   // by mesh ID, m: of smooth ones (sbr_orders.cpp)
  double wavelength_;                // m
  bool has_smooth_ = false;          // differentials are followed only then
  bool has_only_direct_legs_ = false;
};

}  // namespace echopath
