// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// edit_program MAREY [MOTION [MINUTES...]]
//
// Memory and time of the program `marey edit` on long motions, as the system reports them
// for a process of its own (wait4). Memory is the peak above that of an empty recipe on
// one frame, also as a multiple of the poses' size. MOTION (a BVH of a walk) is made as
// long as needed by repeating its best cycle, and disturbed; without it a walk is made.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "edit/render.h"
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/motion/retarget_files.h"
#include "core/base/stopwatch.h"
#include "core/transform.h"
#include "recordings/motion/npz.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey {
namespace {

namespace fs = std::filesystem;
constexpr double kRate_hz = 120.0;

struct Cost {
  int exit_code = -1;
  double peak_bytes = 0.0;
  double cpu_s = 0.0;
  double wall_s = 0.0;
};

Cost cost_of(const std::vector<std::string>& words) {
  Cost out;
  const Stopwatch watch;
  const pid_t child = fork();
  if (child == 0) {
    std::vector<char*> arguments;
    for (const std::string& word : words) {
      arguments.push_back(const_cast<char*>(word.c_str()));
    }
    arguments.push_back(nullptr);
    const int nothing = open("/dev/null", O_RDWR);
    dup2(nothing, STDOUT_FILENO);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  int status = 0;
  rusage used{};
  if (child < 0 || wait4(child, &status, 0, &used) != child) return out;
  out.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  out.peak_bytes = 1024.0 * static_cast<double>(used.ru_maxrss);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  out.cpu_s = seconds(used.ru_utime) + seconds(used.ru_stime);
  out.wall_s = watch.seconds();
  return out;
}

/// Repeats the best cycle of a walk.
Motion repeated(const Motion& walk, int frames) {
  auto state = edit::make_edit_state(walk);
  if (!state) {
    std::printf("%s\n", state.error().message().c_str());
    return {};
  }
  edit::EditInputs inputs;
  inputs.sources.emplace("", *std::move(state));
  EditRecipe recipe;
  recipe.sources.emplace_back();
  CyclifyOp cyclify;
  EditOp op;
  op.parameters = cyclify;
  recipe.ops.push_back(op);
  const auto once = edit::render(recipe, inputs);
  if (!once) {
    std::printf("%s\n", once.error().message().c_str());
    return {};
  }
  cyclify.cycles = frames / once->outputs.front().frame_count() + 1;
  recipe.ops.front().parameters = cyclify;
  auto all = edit::render(recipe, inputs);
  if (!all) return {};
  Motion out = std::move(all->outputs.front().motion);
  out.poses.resize(static_cast<std::size_t>(frames));
  return out;
}

Motion long_walk(const std::string& file, int frames) {
  if (file.empty()) {
    return testing::synthetic_walk(frames, kRate_hz, 0.002, 0.0005).motion;
  }
  const auto clip = app::read_motion(app::BodyFile(file));
  if (!clip) {
    std::printf("%s\n", clip.error().message().c_str());
    std::exit(1);
  }
  Motion out = repeated(clip->motion, frames);
  if (out.poses.empty()) std::exit(1);
  testing::Dice dice(1);
  for (Pose& pose : out.poses) {
    for (glm::dquat& q : pose.parent_from_joint) {
      q = q *
          rotation_from_vector({dice.noise(0.002), dice.noise(0.002), dice.noise(0.002)});
    }
    pose.root_in_world +=
        glm::dvec3(dice.noise(5e-4), dice.noise(5e-4), dice.noise(5e-4));
  }
  return out;
}

void write_recipe(const fs::path& file, const std::vector<std::string>& ops) {
  std::ofstream out(file);
  out << "format = 1\n[source]\npath = \"" << file.stem().stem().string() << ".npz\"\n";
  for (const std::string& op : ops) out << "[[op]]\ndo = \"" << op << "@1\"\n";
}

class ProgramCosts {
 public:
  explicit ProgramCosts(std::string program) : program_(std::move(program)) {
    write("one", testing::synthetic_walk(1, kRate_hz).motion);
    write_recipe(folder_ / "one.edit.toml", {});
    empty_ = cost_of({program_, "edit", path("one.edit.toml"), "--out", path("one")});
    std::printf("an empty recipe on one frame: exit code %d, %.1f MB, %.2f s\n",
                empty_.exit_code,
                1e-6 * empty_.peak_bytes,
                empty_.cpu_s);
  }

  void write(const std::string& name, const Motion& motion) {
    if (!recordings::write_npz(folder_ / (name + ".npz"), motion)) std::exit(1);
    const std::size_t joints = motion.skeleton.joints.size();
    motion_bytes_ = static_cast<double>(motion.poses.size() *
                                        (sizeof(Pose) + joints * sizeof(glm::dquat)));
  }
  /// Measures a recipe on the motion of the last write().
  void measure(const std::string& name,
               const std::vector<std::string>& ops,
               const std::vector<std::string>& options) {
    write_recipe(folder_ / (name + ".edit.toml"), ops);
    std::vector<std::string> words{program_, "--progress", "none", "edit"};
    words.push_back(path(name + ".edit.toml"));
    words.insert(words.end(), options.begin(), options.end());
    words.insert(words.end(), {"--out", path("out")});
    const Cost cost = cost_of(words);
    std::string text;
    for (const std::string& op : ops) text += op + " ";
    for (const std::string& option : options) text += option + " ";
    const double above = cost.peak_bytes - empty_.peak_bytes;
    std::printf("  %-42s exit code %d, %7.2f s CPU, %7.2f s, %8.1f MB = %.2f motions\n",
                text.c_str(),
                cost.exit_code,
                cost.cpu_s,
                cost.wall_s,
                1e-6 * above,
                above / motion_bytes_);
    std::fflush(stdout);
  }
  [[nodiscard]] double motion_bytes() const { return motion_bytes_; }

 private:
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }

  testing::ScratchFolder folder_;
  std::string program_;
  Cost empty_;
  double motion_bytes_ = 0.0;
};

int run(const std::string& program, const std::string& file, std::vector<int> minutes) {
  ProgramCosts costs(program);
  if (minutes.empty()) minutes = {1, 6, 60};
  for (const int length : minutes) {
    const std::string name = "walk" + std::to_string(length);
    costs.write(name, long_walk(file, static_cast<int>(length * 60 * kRate_hz)));
    std::printf("%d min at %.0f Hz, poses of %.1f MB\n",
                length,
                kRate_hz,
                1e-6 * costs.motion_bytes());
    const std::vector<std::string> npz{"--format", "npz"};
    costs.measure(name, {}, {"--check"});
    costs.measure(name, {}, npz);
    costs.measure(name, {"cut", "filter", "plant"}, {"--check"});
    costs.measure(name, {"cut", "filter", "plant"}, npz);
    costs.measure(name, {"cut", "filter", "plant", "cyclify"}, {});
    if (length > 1) continue;
    costs.measure(name, {"cut", "filter", "plant"}, {});
    costs.measure(name,
                  {"cut", "filter", "plant", "cyclify"},
                  {"--page", "--port", "0", "--no-open", "--seconds", "20"});
  }
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc < 2) {
    std::printf("usage: edit_program MAREY [MOTION [MINUTES...]]\n");
    return 2;
  }
  std::vector<int> minutes;
  for (int i = 3; i < argc; ++i) minutes.push_back(std::atoi(argv[i]));
  return marey::run(argv[1], argc > 2 ? argv[2] : "", std::move(minutes));
}
