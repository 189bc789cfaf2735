// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/library/export/export_scene.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>

#include "library/clips/normal_form.h"

#include "core/human/average_proportions.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/sha256.h"
#include "recordings/library/clip_record_file.h"
#include "recordings/library/library_index.h"
#include "recordings/library/motion_object.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

template <class T>
T needed(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return *std::move(result);
}

/// Writes the object of a motion. Returns its key.
std::string store(const fs::path& library, const Motion& motion) {
  const auto object = needed(library::make_library_motion(motion));
  const std::string bytes = needed(recordings::motion_object_bytes(object));
  const std::string key = recordings::sha256(bytes);
  needed(recordings::write_file(library / recordings::object_path(key, ".npz"), bytes));
  return key;
}

ClipRecord record_of(const std::string& name,
                     const std::string& key,
                     const Motion& motion,
                     int first,
                     int last) {
  ClipRecord out;
  out.name = name;
  out.object_key = key;
  out.first_frame = first;
  out.last_frame = last;
  out.rate_hz = motion.rate.hz;
  out.provenance.source_id = recordings::sha256("source " + key);
  out.provenance.path = "motions/" + name.substr(0, name.find('.')) + ".bvh";
  out.provenance.kind = "bvh";
  out.clip_id = recordings::clip_id_of(out.provenance.source_id, "", first, last);
  out.figures = {{"slide_cm_s", 1.25, Verdict::kPass, "leftFoot", FrameRange{3, 7}}};
  return out;
}

}  // namespace

ExportScene::ExportScene() {
  Motion walk = synthetic_walk(120, 60.0, 0.02, 0.002).motion;
  walk.first_frame = 100;
  const std::string walk_key = store(library(), walk);
  records_.push_back(record_of("walk.001", walk_key, walk, 110, 169));
  records_.push_back(record_of("walk.002", walk_key, walk, 160, 219));
  for (ClipRecord& clip : records_) {
    clip.provenance.subject = "anna";
    clip.provenance.licence = "CC-BY-4.0";
    clip.provenance.attribution = "Anna's, lab, 2024";
  }
  records_[0].labels = {{0.0, 0.5, "turn left", "table", 1.0},
                        {0.25, 0.75, "a \"leftish\", step", "anna", 0.5}};
  records_[0].events = {{6, "left.strike"}, {30, "right.strike"}};

  const Motion plain = synthetic_walk(90, 30.0).motion;
  const Motion child = needed(retarget::retarget_motion(
                                  plain, make_humanoid(average_proportions(1.3)), {}))
                           .motion;
  records_.push_back(record_of("child", store(library(), child), child, 0, 89));
  records_[2].provenance.subject = "bo/\xc3\xa4";
  records_[2].provenance.licence = "MIT";

  Motion stiff = synthetic_walk(40, 30.0).motion;
  stiff.skeleton.joints[index(HumanBone::kUpperChest)].bone = std::nullopt;
  records_.push_back(record_of("stiff", store(library(), stiff), stiff, 0, 39));
  records_[3].provenance.licence = "CC0-1.0";
  records_[3].quality = Verdict::kWarn;

  recordings::IndexHead head;
  head.version = 10;
  head.version_name = std::string(64, 'f');
  needed(recordings::write_library_index(library() / "library.sqlite", records_, head));
}

app::ExportOptions ExportScene::options(app::ExportFormat format,
                                        const std::string& name) const {
  app::ExportOptions out;
  out.library = library();
  out.out = this->out(name);
  out.format = format;
  out.splits = LibrarySettings{}.splits;
  return out;
}

Result<app::ExportReport> ExportScene::run(const app::ExportOptions& options,
                                           std::vector<int> numbers) const {
  if (numbers.empty()) {
    numbers.resize(records_.size());
    std::iota(numbers.begin(), numbers.end(), 0);
  }
  return app::export_library(options, records_, numbers);
}

std::string hash_folder(const fs::path& folder) {
  std::set<std::string> lines;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    lines.insert(entry.path().lexically_relative(folder).string() + " " +
                 needed(recordings::sha256_of_file(entry.path())) + "\n");
  }
  return std::accumulate(lines.begin(), lines.end(), std::string());
}

}  // namespace marey::testing
