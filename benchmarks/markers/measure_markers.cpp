// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Compares subjects and motions that are fitted to labelled markers with published
// results of the same recordings:
//
//   measure_markers QUESTION ../shared/data/mocap
//
// running   distance of markers from the body, and of markers that were held out
// flexion   knees, hips and ankles against OpenSim's inverse kinematics
// studio    joints against the skeleton that CMU's studio solved
// dropouts  joints from tracks with gaps, swaps, noise and spikes against clean ones
// speed     time and memory, batch and live
// flight    take-off and landing of a jump against force plates
//
// The person is fitted from the tracks alone every time: nothing is given.
#include <array>
#include <string_view>

#include "benchmarks/markers/marker_subject.h"

int main(int argc, char** argv) {
  struct Question {
    std::string_view name;
    int (*measure)(const std::filesystem::path&);
  };
  const std::array questions{
      Question{"running", marey::measure_running},
      Question{"flexion", marey::measure_flexion},
      Question{"studio", marey::measure_studio},
      Question{"dropouts", marey::measure_dropouts},
      Question{"speed", marey::measure_speed},
      Question{"flight", marey::measure_flight},
  };
  if (argc == 3) {
    for (const Question& question : questions) {
      if (question.name == argv[1]) return question.measure(argv[2]);
    }
  }
  marey::stop(
      "usage: measure_markers running|flexion|studio|dropouts|speed|flight MOCAP");
}
