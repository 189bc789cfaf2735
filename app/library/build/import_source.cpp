// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/import_source.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "library/clips/normal_form.h"
#include "library/clips/put_on_floor.h"

#include "app/library/build/make_clips.h"
#include "app/library/sources/read_source.h"
#include "recordings/base/atomic_file.h"
#include "recordings/library/clip_record_file.h"
#include "recordings/library/motion_object.h"
#include "recordings/library/source_stage.h"
#include "retarget/body/body_map.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using recordings::object_path;
using recordings::OnDisk;
using recordings::SourceStage;

bool has_object(const BuildInputs& inputs,
                const std::string& key,
                std::string_view extension) {
  std::error_code failed;
  return fs::is_regular_file(inputs.library / object_path(key, extension), failed);
}

/// Writes objects. A failure belongs to the library's disk, not to a source.
class ObjectWriter {
 public:
  explicit ObjectWriter(const std::filesystem::path& library) : library_(library) {}

  [[nodiscard]] Status write(const std::string& key,
                             std::string_view extension,
                             const std::string& bytes) {
    const Status ok = recordings::write_file(
        library_ / object_path(key, extension), bytes, OnDisk::kNow);
    if (!ok) has_failed_ = true;
    return ok;
  }
  [[nodiscard]] bool has_failed() const { return has_failed_; }

 private:
  const std::filesystem::path& library_;
  bool has_failed_ = false;
};

/// Removes the source's path from the place of an error, as objects have no paths.
Error without_path(Error error, const SourceFile& file) {
  const std::string path = file.path.string();
  if (error.where.starts_with(path)) error.where.erase(0, path.size());
  while (error.where.starts_with(':') || error.where.starts_with(' ')) {
    error.where.erase(0, 1);
  }
  return error;
}

/// Puts the name of the source before the place of an error.
Error with_name(Error error, const SourceFile& file) {
  error.where = error.where.empty() ? file.name : file.name + ": " + error.where;
  return error;
}

/// Reads the stage if all of its objects exist, whole.
std::optional<SourceStage> find_stage(const BuildInputs& inputs, const std::string& key) {
  if (!has_object(inputs, key, ".json")) return std::nullopt;
  const auto text = recordings::read_file(inputs.library / object_path(key, ".json"));
  if (!text) return std::nullopt;
  auto stage = recordings::parse_source_stage(*text);
  if (!stage) return std::nullopt;
  for (std::size_t i = 0; i < stage->bodies.size(); ++i) {
    std::error_code failed;
    const auto bytes = fs::file_size(
        inputs.library / object_path(stage->bodies[i].object_key, ".npz"), failed);
    if (failed || bytes != stage->motion_bytes[i]) return std::nullopt;
  }
  return stage;
}

/// Removes the objects of a stage, so that they are made again.
void remove_stage(const BuildInputs& inputs,
                  const SourceStage& stage,
                  const std::string& key) {
  std::error_code ignored;
  fs::remove(inputs.library / object_path(key, ".json"), ignored);
  for (const ClipRecord& body : stage.bodies) {
    fs::remove(inputs.library / object_path(body.object_key, ".npz"), ignored);
  }
}

/// Makes the motion of one body an object, and adds the body to the stage.
Status add_body(ObjectWriter& objects,
                const std::string& motion_key,
                const SourceFile& file,
                SourceMotion source,
                SourceStage& stage) {
  auto clip = library::make_library_motion(source.motion, std::move(source.uncertainty));
  if (!clip) return without_path(clip.error(), file);
  const auto map = retarget::map_body(clip->motion.skeleton);
  if (!map) return without_path(map.error(), file);
  constexpr double kMillimetres = 1000.0;
  const double shift_m = library::put_on_floor(clip->motion, *map);
  ClipRecord body;
  body.body = source.body;
  body.object_key = recordings::stage_key("", "body", 1, source.body, motion_key);
  body.first_frame = clip->motion.first_frame;
  body.last_frame = body.first_frame + static_cast<int>(clip->motion.poses.size()) - 1;
  body.rate_hz = clip->motion.rate.hz;
  body.rate_by = source.rates.basis();
  body.provenance.subject = source.subject;
  body.figures = std::move(source.figures);
  body.figures.push_back({"floor_shift_mm", kMillimetres * shift_m, {}, "", {}});
  body.problems = std::move(source.problems);
  body.labels = std::move(source.labels);
  body.events = std::move(source.events);
  const auto bytes = recordings::motion_object_bytes(*clip);
  if (!bytes) return without_path(bytes.error(), file);
  const Status ok = objects.write(body.object_key, ".npz", *bytes);
  if (!ok) return ok;
  stage.bodies.push_back(std::move(body));
  stage.motion_bytes.push_back(bytes->size());
  return Done{};
}

/// Reads a source and makes the objects of its bodies.
Result<SourceStage> make_stage(const BuildInputs& inputs,
                               ObjectWriter& objects,
                               const SourceFile& file,
                               const std::string& motion_key) {
  ReadSourceOptions options;
  options.clean = inputs.settings.clean;
  if (const auto entry = inputs.find_in_table(file)) {
    options.table_rate_hz = entry->rate_hz;
    options.table_duration_s = entry->duration_s;
    options.table_evidence = entry->evidence;
  }
  auto motions = read_source(file, inputs.settings.sources[file.source], options);
  if (!motions) return without_path(motions.error(), file);
  SourceStage stage;
  for (SourceMotion& motion : *motions) {
    stage.remarks.insert(
        stage.remarks.end(), motion.remarks.begin(), motion.remarks.end());
    const Status ok = add_body(objects, motion_key, file, std::move(motion), stage);
    if (!ok) return ok.error();
  }
  return stage;
}

/// Makes the stage's object, also that of a failure which the source's content causes.
Result<SourceStage> import_stage(const BuildInputs& inputs,
                                 ObjectWriter& objects,
                                 const SourceFile& file,
                                 const KnownSource& known,
                                 const std::string& key) {
  if (auto found = find_stage(inputs, key)) return std::move(*found);
  auto stage = make_stage(inputs, objects, file, key);
  // Neither the result nor the failure is that of the identified content.
  if (!known.is_current()) return without_path(changed_while_read(file), file);
  if (!stage) {
    if (objects.has_failed() || stage.error().code != Errc::kBadInput) {
      return stage.error();
    }
    SourceStage failed;
    failed.failure = stage.error();
    stage = std::move(failed);
  }
  const Status ok = objects.write(key, ".json", recordings::source_stage_text(*stage));
  if (!ok) return ok.error();
  return stage;
}

/// Makes the records and features of a source's clips.
Status import_clips(const BuildInputs& inputs,
                    ObjectWriter& objects,
                    const SourceFile& file,
                    const SourceStage& stage,
                    const std::string& source_id,
                    const std::string& key) {
  const auto clips = make_clips(inputs, file, stage, source_id);
  if (!clips) return clips.error();
  if (const Status ok = objects.write(key, ".f32", clips->features); !ok) return ok;
  // The records last: if they exist, so do the features.
  return objects.write(key, ".json", recordings::clip_records_text(clips->records));
}

/// Makes all objects of a source. Returns its stage.
Result<SourceStage> import_objects(const BuildInputs& inputs,
                                   ObjectWriter& objects,
                                   const SourceFile& file,
                                   const KnownSource& known,
                                   const SourceKeys& keys) {
  // Twice, if an existing motion turns out to be damaged.
  for (bool is_again = false;; is_again = true) {
    auto stage = import_stage(inputs, objects, file, known, keys.motion);
    if (!stage || stage->failure) return stage;
    const Status ok = import_clips(inputs, objects, file, *stage, known.id, keys.clips);
    if (ok) return stage;
    if (is_again || objects.has_failed()) return ok.error();
    remove_stage(inputs, *stage, keys.motion);
  }
}

}  // namespace

std::optional<SourceOutcome> find_outcome(const BuildInputs& inputs,
                                          const SourceFile& file,
                                          const std::string& source_id) {
  const SourceKeys keys = keys_of(inputs, file, source_id);
  SourceOutcome out;
  out.name = file.name;
  out.source_id = source_id;
  const auto stage = find_stage(inputs, keys.motion);
  if (!stage) return std::nullopt;
  out.remarks = stage->remarks;
  if (stage->failure) {
    out.failure = with_name(*stage->failure, file);
    return out;
  }
  if (!has_object(inputs, keys.clips, ".json") ||
      !has_object(inputs, keys.clips, ".f32")) {
    return std::nullopt;
  }
  out.clips_key = keys.clips;
  return out;
}

ImportedSource import_source(const BuildInputs& inputs, const SourceFile& file) {
  ImportedSource out;
  out.outcome.name = file.name;
  const auto fail = [&](const Error& error) {
    out.outcome.failure = with_name(error, file);
    out.outcome.is_machine_failure = error.code == Errc::kDevice;
  };
  auto known = know_source(file);
  if (!known) {
    fail(without_path(known.error(), file));
    return out;
  }
  out.outcome.source_id = known->id;
  out.known = *known;
  if (auto found = find_outcome(inputs, file, known->id)) {
    out.outcome = std::move(*found);
    return out;
  }
  const SourceKeys keys = keys_of(inputs, file, known->id);
  ObjectWriter objects(inputs.library);
  out.outcome.was_read = !find_stage(inputs, keys.motion);
  const auto stage = import_objects(inputs, objects, file, *known, keys);
  if (!stage || stage->failure) {
    fail(stage ? *stage->failure : stage.error());
    if (objects.has_failed()) out.outcome.is_machine_failure = true;
    return out;
  }
  out.outcome.remarks = stage->remarks;
  out.outcome.clips_key = keys.clips;
  return out;
}

}  // namespace marey::app
