// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads labelled markers (C3D or TRC), measures the subject and solves its motion.
//
//     fit_markers FILE.c3d...
//
// All files show the same subject. The more its joints move, the better the result.
#include "reconstruct/markers/fit_markers.h"

#include <cstdio>
#include <vector>

#include "core/humanoid.h"
#include "core/skeleton.h"
#include "reconstruct/labels/name_markers.h"
#include "reconstruct/markers/solve_markers.h"
#include "recordings/markers/marker_file.h"

using namespace marey;

namespace {

int fail(const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.message().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<MarkerTracks> trials;
  for (int i = 1; i < argc; ++i) {
    auto file = recordings::read_markers(argv[i]);
    if (!file) return fail(file.error());
    trials.push_back(std::move(file->tracks));
  }
  if (trials.empty()) return fail(bad_input("", "no file is given", "name a C3D or TRC"));

  // The labels of the first trial: other trials of a subject have the same ones.
  const std::vector<std::string>& labels = trials.front().labels;
  const reconstruct::MarkerNames names = reconstruct::name_markers(labels);
  std::vector<reconstruct::NamedMarker> markers;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (!names.is_computed[i]) markers.push_back({labels[i], names.landmarks[i]});
  }

  const auto fit = reconstruct::fit_markers({}, trials, markers);
  if (!fit) return fail(fit.error());
  const Proportions& lengths = fit->body.proportions;
  std::printf("stature_m %.4f\n", fit->body.stature_m);
  std::printf("leg_m %.4f\n", leg_length_m(lengths));
  std::printf("hips_width_m %.4f\n",
              lengths[HumanBone::kLeftUpperLeg].x - lengths[HumanBone::kRightUpperLeg].x);

  for (int i = 1; i < argc; ++i) {
    const auto motion =
        reconstruct::solve_markers(fit->body, trials[static_cast<std::size_t>(i) - 1]);
    if (!motion) return fail(bad_input(argv[i], "too few markers", "see its labels"));
    std::printf("%s: frames %d, marker_rms_mm %.2f\n",
                argv[i],
                motion->frames_solved,
                1000.0 * motion->rms_m);
  }
  return 0;
}
