#pragma once
// Describes the waveform, the antennas and the radar that carries them.
#include <cstdint>
#include <memory>
#include <vector>

#include "echopath/base/frequency_band.h"
#include "echopath/base/geometry.h"
#include "echopath/motion/motion.h"
#include "echopath/radar/gain_table.h"

namespace echopath {

// Describes a frame of linear chirps, which rise or fall. `bandwidth` is what the num_samples samples sweep, below 0 where
// chirps fall. The slots of a frame, one chirp each, may differ: slot i takes entry i modulo the length of each of the three
// last lists, which are empty where all are alike.
struct ChirpSequence {
  double start_frequency = 77e9;             // Hz, at the first sample
  double bandwidth = 1e9;                    // Hz, sampled, < 0 of chirps that fall
  int num_samples = 512;                     // per chirp
  double sampling_rate = 20e6;               // Hz
  int num_chirps = 128;                      // per transmitter
  double chirp_interval = 60e-6;             // s, between neighbouring slots
  bool real = false;                         // real IF samples instead of complex
  std::vector<double> extra_idle = {};       // s, >= 0, by which the slot after this one begins later
  std::vector<double> frequency_steps = {};  // Hz, added to the start frequency
  std::vector<double> bandwidth_steps = {};  // Hz, added to the bandwidth

  void validate() const;  // raises invalid_argument naming the field, the rule and the value
  bool falls() const { return bandwidth < 0.0; }
  double slope() const { return bandwidth * sampling_rate / num_samples; }          // Hz/s, < 0 of chirps that fall
  double chirp_duration() const { return num_samples / sampling_rate; }             // s, sampled
  double window_centre() const { return 0.5 * (num_samples - 1) / sampling_rate; }  // s after the first sample
  double centre_frequency() const { return start_frequency + 0.5 * bandwidth; }     // Hz
  FrequencyBand band() const;                                                       // of all chirps
  double wavelength() const;                                                        // m, at the centre frequency
  double mean_interval() const;                                                     // s, between neighbouring slots
  double slot_start(int64_t slot) const;                                            // s after the first slot's
  double range_resolution() const;                                                  // m, c / 2 |B|
  double max_range() const;                                                         // m, c fs / (2 |slope|), half if real
  double velocity_resolution(int num_slots) const;                                  // m/s
  double max_velocity(int num_slots) const;                                         // m/s, unambiguous within +-
};

// Describes power gain over direction. Boresight is +x of the antenna's frame.
struct AntennaPattern {
  enum class Kind { kIsotropic, kCosinePower, kTable };
  Kind kind = Kind::kIsotropic;
  double peak_gain = 1.0;                  // linear
  double exponent = 0.0;                   // gain = peak_gain cos^exponent(theta) in front, 0 behind (kCosinePower)
  std::shared_ptr<const GainTable> table;  // kTable

  static AntennaPattern isotropic(double gain = 1.0);
  // A peak_gain <= 0 stands for that of a lossless antenna, 2 (exponent + 1).
  static AntennaPattern cosine_power(double exponent, double peak_gain = 0.0);
  static AntennaPattern of_table(GainTable table);
  // Returns the linear power gain of a pattern that is symmetric about the boresight; raises invalid_argument for a table.
  double gain(double cos_boresight) const;
  AntennaGain toward(const Vec3& direction) const {  // a unit vector in the antenna's frame
    return toward(direction.x(), [&] { return direction; });
  }
  // Returns the same; a table alone asks for `direction()`.
  template <class Direction>
  AntennaGain toward(double cos_boresight, const Direction& direction) const {
    return table ? table->toward(direction()) : AntennaGain{gain(cos_boresight), 0.0};
  }
  double largest_field() const;  // sqrt(gain) that no direction exceeds
  double sharpness() const;      // 1/rad, of its field (kSlopeOfSharpness); 0 for kIsotropic
  double efficiency() const;     // integral of the gain over the sphere / 4 pi
  bool is_dark_behind() const;   // no gain where x < 0
};

// Returns the rotation that turns +x by `yaw` about z (to the left), then up by `pitch` in the vertical plane through it:
// R_z(yaw) R_y(-pitch), both in rad. +x becomes (cos pitch cos yaw, cos pitch sin yaw, sin pitch), and +y stays level. By
// this one rule radars and antennas are turned; its yaw is that of the nodes of a scene.
Quaternion turned(double yaw, double pitch);

struct Antenna {
  Vec3 position = Vec3::Zero();                     // m, in the radar's frame
  Quaternion orientation = Quaternion::Identity();  // radar_from_antenna
  AntennaPattern pattern;
  Vec3 polarization = Vec3::UnitZ();  // in the antenna's frame, unit
};

// Returns whether both have one pattern, but for its level, and look the same way.
bool have_one_beam(const Antenna& a, const Antenna& b);

// Returns the mean position of at least one antenna in the world, m. Raises invalid_argument where it is out of the range of
// coordinates (base/range_of_coordinates.h).
Vec3 mean_position(const std::vector<Antenna>& antennas, const Transform& world_from_radar);

// Returns the sum of the unit vectors to which the antennas look, in the radar's frame: short where they look to all sides.
Vec3 sum_of_boresights(const std::vector<Antenna>& antennas);

// Says how transmitters share the chirps. With kTdm, one transmitter sends in each slot. With the others, all transmitters
// send in all slots, each with a code over the slots; echoes and cubes, [tx, rx, chirp, sample], are then those of each
// transmitter by itself, as a receiver has them that undoes the code. kBpm uses the signs of a Hadamard matrix over
// num_slots slots, which make one chirp. With kDdm the phase of transmitter m advances by m / (transmitters + empty_slots)
// of a cycle from chirp to chirp, with kCdm by code_phases[m].
enum class Multiplexing { kTdm, kBpm, kDdm, kCdm };

struct Radar {
  ChirpSequence waveform;
  std::vector<Antenna> transmitters, receivers;
  double transmit_power = 0.01;  // W per transmitter
  double noise_figure_db = 12.0;
  Multiplexing multiplexing = Multiplexing::kTdm;
  Vec3 position = Vec3::Zero();          // m, in the world: origin of the radar's frame
  double yaw = 0.0, pitch = 0.0;         // rad, of the radar's frame in the world, see `turned`
  std::shared_ptr<const Motion> motion;  // moves the placed radar (see `moved`); null: at rest
  int empty_slots = 1;                   // of kDdm, at least 1: shares of the Doppler axis that no transmitter is moved to
  std::vector<std::vector<double>> code_phases = {};  // rad, [tx, slots], of kCdm, repeated; empty for others
  std::shared_ptr<const void> receiver = {};          // what follows the ideal signal, for those who know it; null: nothing

  void validate() const;
  // Raises invalid_argument where the chirps cannot carry the code of the transmitters: of radars as their users give them.
  // Those that a step of the work cuts to some antennas or chirps need not fit: echoes are those of each transmitter alone.
  void validate_code_fits() const;
  bool is_moving() const { return moves(motion); }
  bool takes_turns() const { return multiplexing == Multiplexing::kTdm; }
  // Returns how many slots make one of the num_chirps: one for each transmitter, or the length of the BPM code, or 1.
  int num_slots() const;
  // Returns Translation(position) motion(time) R(yaw, pitch): a velocity is in the axes of the world, and the radar turns
  // about its own origin, as the nodes of a scene do.
  Transform world_from_radar(double time) const;
  // Returns the time (s after the frame's start) of the window centre of chirp `chirp` of transmitter `tx`; of simultaneous
  // codes that of its first slot.
  double chirp_time(int tx, int chirp) const;
  double frame_duration() const;  // s, from the first sample to the last
  // Returns the middle of a frame that starts at `start_time`, when its rays see the scene, in s.
  double middle_of_frame(double start_time) const { return start_time + 0.5 * frame_duration(); }
};

// Returns the radar with one of its transmitters and one of its receivers alone, which must be there.
Radar one_channel(const Radar& radar, size_t tx = 0, size_t rx = 0);

}  // namespace echopath
