// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Errors of the zero moment point against force plates: a walk with markers. Usage:
//   measure_zmp [MOCAP_FOLDER]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "dynamics/balance/zero_moment_point.h"
#include "dynamics/momentum/angular_momentum.h"
#include <glm/vec2.hpp>

#include "benchmarks/retarget/contact_trials.h"
#include "recordings/markers/marker_file.h"
#include "recordings/motion/mot.h"
#include "retarget/body/place_masses.h"

namespace marey {
namespace {

// Part of the walk in which all standing feet are on plates.
constexpr double kFrom_s = 0.55;
constexpr double kTo_s = 1.85;
// In frames in which plates and motion disagree by more, a foot is not on a plate.
constexpr double kSameForce_g = 0.1;

// Sum of the plates at one instant.
struct PlateSum {
  double force_y_N = 0.0;
  glm::dvec2 centre_xz_m{0.0};
};

[[noreturn]] void fail(const std::string& text) {
  std::fprintf(stderr, "%s\n", text.c_str());
  std::exit(1);
}

class PlateTable {
 public:
  explicit PlateTable(recordings::MotTable table) : table_(std::move(table)) {
    for (const char* side : {"r", "l"}) {
      const std::string stem = std::string("ground_force_") + side + "_";
      columns_.push_back({column(stem + "vy"), column(stem + "px"), column(stem + "pz")});
    }
  }

  // Returns the mean over `width_s` around a time on the plates' clock.
  [[nodiscard]] PlateSum mean(double time_s, double width_s) const {
    PlateSum out;
    int rows = 0;
    glm::dvec2 moment(0.0);
    for (std::size_t row = 0; row < table_.rows(); ++row) {
      if (std::abs(table_.time_s[row] - time_s) > 0.5 * width_s) continue;
      ++rows;
      for (const auto& [vy, px, pz] : columns_) {
        const double force_N = table_.at(row, vy);
        if (force_N < kLoaded_N) continue;
        out.force_y_N += force_N;
        moment += force_N * glm::dvec2(table_.at(row, px), table_.at(row, pz));
      }
    }
    if (out.force_y_N > 0.0) out.centre_xz_m = moment / out.force_y_N;
    out.force_y_N /= std::max(rows, 1);
    return out;
  }

 private:
  [[nodiscard]] std::size_t column(const std::string& name) const {
    const auto found = table_.find(name);
    if (!found) fail("the force table has no column " + name);
    return *found;
  }

  recordings::MotTable table_;
  std::vector<std::array<std::size_t, 3>> columns_;
};

// Mean and standard deviation per axis, in millimetres.
class Spread {
 public:
  void add(const glm::dvec2& off_m) { all_.push_back(1e3 * off_m); }
  void print(const char* name) const {
    const auto count = static_cast<double>(all_.size());
    glm::dvec2 mean(0.0);
    for (const glm::dvec2& one : all_) mean += one / count;
    glm::dvec2 square(0.0);
    for (const glm::dvec2& one : all_) square += (one - mean) * (one - mean) / count;
    std::printf("%-28s %4zu %10.1f %10.1f %10.1f %10.1f\n",
                name,
                all_.size(),
                std::sqrt(square.x),
                std::sqrt(square.y),
                mean.x,
                mean.y);
  }

 private:
  std::vector<glm::dvec2> all_;
};

std::vector<glm::dvec3> momentum_per_kg(
    const std::vector<dynamics::CentroidalState>& states) {
  std::vector<glm::dvec3> out;
  for (const auto& state : states) {
    out.push_back(state.angular_momentum_kg_m2_s / state.mass_kg);
  }
  return out;
}

int measure(const std::filesystem::path& mocap) {
  const auto sources = contact_sources();
  const auto source =
      std::find_if(sources.begin(), sources.end(), [](const ContactSource& one) {
        return one.name == "Rajagopal walk";
      });
  if (source == sources.end()) fail("the walk is not in the list of recordings");
  const auto trial = read_contact_trial(mocap, *source);
  if (!trial) fail(trial.error().message());
  const auto markers = recordings::read_markers(mocap / source->markers);
  if (!markers) fail(markers.error().message());
  auto forces = recordings::read_mot(mocap / source->forces);
  if (!forces) fail(forces.error().message());
  const PlateTable plates(std::move(*forces));
  const Motion& motion = trial->motion;
  const double start_s = markers->tracks.start_s;
  const auto time_s = [&](std::size_t t) {
    return start_s + static_cast<double>(t) / motion.rate.hz;
  };

  // The person's mass: the mean load of both plates over the time on them.
  double weight_N = 0.0;
  int weighed = 0;
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    if (time_s(t) < kFrom_s || time_s(t) > kTo_s) continue;
    weight_N += plates.mean(time_s(t), 1.0 / motion.rate.hz).force_y_N;
    ++weighed;
  }
  weight_N /= weighed;
  MassSpec spec;
  spec.total_kg = weight_N / dynamics::kStandardGravity_m_s2;
  const auto masses = retarget::place_masses(motion.skeleton, trial->map, spec);
  if (!masses) fail(masses.error().message());
  const auto states =
      dynamics::centroidal_states(motion.skeleton, *masses, motion.rate, motion.poses);
  std::vector<glm::dvec3> com;
  for (const auto& state : states) com.push_back(state.com_in_world);
  const auto with = dynamics::ground_reactions(com, momentum_per_kg(states), motion.rate);
  const auto without = dynamics::ground_reactions(com, {}, motion.rate);

  Spread zmp;
  Spread cart_table;
  Spread projection;
  double force_off_g = 0.0;
  for (std::size_t t = 0; t < com.size(); ++t) {
    if (time_s(t) < kFrom_s || time_s(t) > kTo_s) continue;
    const PlateSum sum = plates.mean(time_s(t), 1.0 / motion.rate.hz);
    const double off_g = (sum.force_y_N / *spec.total_kg - with[t].force_m_s2.y) /
                         dynamics::kStandardGravity_m_s2;
    if (std::abs(off_g) > kSameForce_g || !with[t].zmp_xz_m) continue;
    force_off_g += off_g * off_g;
    zmp.add(*with[t].zmp_xz_m - sum.centre_xz_m);
    cart_table.add(*without[t].zmp_xz_m - sum.centre_xz_m);
    projection.add(glm::dvec2(com[t].x, com[t].z) - sum.centre_xz_m);
  }
  std::printf("%s, %.2f to %.2f s, %.1f kg, %.0f Hz\n",
              source->name.c_str(),
              kFrom_s,
              kTo_s,
              *spec.total_kg,
              motion.rate.hz);
  std::printf(
      "error against plates, mm    frames    sd fore    sd side  bias fore  bias side\n");
  zmp.print("zero moment point");
  cart_table.print("cart-table (no momentum)");
  projection.print("projection of the centre");
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  return marey::measure(argc > 1 ? argv[1] : "../shared/data/mocap");
}
