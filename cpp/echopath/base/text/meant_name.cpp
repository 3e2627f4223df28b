#include "echopath/base/text/meant_name.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>

#include "echopath/base/text/edit_distance.h"

namespace echopath {
namespace {

constexpr size_t kLettersPerSlip = 4;     // a word of so many letters may be misspelt by one
constexpr size_t kShortestBeginning = 3;  // letters

// Holds what others call what a name of ours stands for; of several names the first that is known counts.
struct Synonyms {
  const char* names;
  const char* words;
};
constexpr std::array kSynonyms = {
    Synonyms{"speed velocity", "velocity v vel speed ego_speed ego_velocity speed_mps"},
    Synonyms{"motion", "trajectory track"},
    Synonyms{"yaw", "rotation heading azimuth angle orientation rot theta"},
    Synonyms{"pitch", "elevation tilt"},
    Synonyms{"position", "translation location pos origin offset xyz center centre place"},
    Synonyms{"false_alarm_rate", "pfa p_fa far false_alarm_probability probability_of_false_alarm"},
    Synonyms{"start_frequency frequency", "fc f0 fstart f_start f carrier carrier_frequency centre_frequency "
                                          "center_frequency freq"},
    Synonyms{"bandwidth", "bw b sweep_bandwidth sweep"},
    Synonyms{"sampling_rate", "fs sample_rate adc_rate sampling_frequency sample_frequency"},
    Synonyms{"num_samples", "samples_per_chirp adc_samples n_fast num_adc_samples"},
    Synonyms{"num_chirps", "pulses num_pulses chirps_per_frame n_slow loops num_loops"},
    Synonyms{"chirp_interval", "pri tc t_c chirp_time chirp_period chirp_repetition_interval chirp_duration ramp_time prt"},
    Synonyms{"real", "iq complex is_complex"},
    Synonyms{"transmitters", "tx txs tx_antennas transmit_antennas antennas"},
    Synonyms{"receivers", "rx rxs rx_antennas receive_antennas antennas"},
    Synonyms{"transmit_power", "tx_power pt p_t power eirp"},
    Synonyms{"noise_figure_db", "nf noise_figure"},
    Synonyms{"peak_gain gain", "gain_db directivity gain"},
    Synonyms{"num_rays", "rays n_rays nrays number_of_rays num_samples samples spp"},
    Synonyms{"max_bounces", "depth max_depth bounces num_bounces max_reflections reflections max_order max_num_bounces"},
    Synonyms{"seed", "rng random_state random_seed"},
    Synonyms{"target_error_db", "error accuracy target_error tolerance_db"},
    Synonyms{"zero_pad", "pad padding zero_padding oversampling oversample nfft n_fft"},
    Synonyms{"window", "win taper windowing"},
    Synonyms{"tolerance", "tol eps rtol precision"},
    Synonyms{"path", "filename file fname file_name filepath"},
    Synonyms{"name", "label id tag"},
    Synonyms{"material", "mat surface"},
    Synonyms{"permittivity", "eps epsilon eps_r epsilon_r relative_permittivity dielectric_constant"},
    Synonyms{"conductivity", "sigma"},
    Synonyms{"roughness_height", "roughness rms_height rms sigma_h"},
    Synonyms{"vertices", "verts points nodes coordinates"},
    Synonyms{"triangles", "faces indices cells elements"},
    Synonyms{"unit", "scale units"},
    Synonyms{"size", "width length dimensions"},
    Synonyms{"duration", "span end_time length"},
    Synonyms{"incidence", "direction directions angles"},
    Synonyms{"hann", "hanning von_hann"},
    Synonyms{"rect", "rectangular boxcar none uniform"},
    Synonyms{"blackman_harris", "blackmanharris blackman-harris"},
    Synonyms{"chebyshev", "cheb dolph chebwin dolph-chebyshev"},
    Synonyms{"taylor", "taylorwin"},
    Synonyms{"kaiser", "kaiser_bessel kaiser-bessel"},
};

bool is_among(const std::vector<std::string>& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

std::vector<std::string> split(std::string_view text, char between) {
  std::vector<std::string> parts;
  std::istringstream stream{std::string(text)};
  for (std::string part; std::getline(stream, part, between);) {
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

std::string in_small_letters(std::string_view word) {
  std::string small(word);
  std::ranges::transform(small, small.begin(), [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return small;
}

std::string name_of_synonym(const std::string& word, const std::vector<std::string>& known) {
  for (const Synonyms& synonyms : kSynonyms) {
    if (!is_among(split(synonyms.words, ' '), word)) continue;
    for (const std::string& name : split(synonyms.names, ' ')) {
      if (is_among(known, name)) return name;
    }
  }
  return "";
}

// Returns whether one has all words of the other, as num_rays has rays, or begins with it.
bool is_part_of(const std::string& word, const std::string& name) {
  if (word.size() >= kShortestBeginning && name.starts_with(word)) return true;
  const std::vector<std::string> of_word = split(word, '_'), of_name = split(name, '_');
  const auto holds_all = [](const auto& many, const auto& few) {
    return !few.empty() && std::ranges::all_of(few, [&](const auto& one) { return is_among(many, one); });
  };
  return holds_all(of_name, of_word) || holds_all(of_word, of_name);
}

}  // namespace

std::string meant_name(std::string_view given, const std::vector<std::string>& known) {
  const std::string word = in_small_letters(given);
  const std::string of_synonym = name_of_synonym(word, known);
  if (!of_synonym.empty()) return of_synonym;
  std::string best;
  size_t fewest = std::max<size_t>(1, word.size() / kLettersPerSlip) + 1;
  for (const std::string& name : known) {
    const size_t slips = edit_distance(word, name);
    if (slips < fewest && slips < word.size()) best = name, fewest = slips;
  }
  if (!best.empty()) return best;
  const auto found = std::ranges::find_if(known, [&](const auto& name) { return is_part_of(word, name); });
  return found == known.end() ? "" : *found;
}

}  // namespace echopath
