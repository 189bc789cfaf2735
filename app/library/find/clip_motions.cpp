// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/find/clip_motions.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <system_error>
#include <utility>

#include "library/clips/normal_form.h"

#include "app/shell/inside_folder.h"
#include "core/base/hex_digits.h"
#include "core/base/in_quotes.h"
#include "recordings/library/clip_record_file.h"
#include "recordings/library/motion_object.h"

namespace marey::app {
std::string ClipMotions::next_step() const {
  return "delete the file if it exists, then build the library again: marey library "
         "build " +
         library_.string();
}

Result<std::shared_ptr<const LibraryMotion>> ClipMotions::object(const std::string& key) {
  const auto known = std::ranges::find(kept_, key, &Kept::key);
  if (known != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, known);
    return kept_.front().object;
  }
  // The index is a file that anybody can make: it must not name other files.
  if (!is_hex(key, 64)) {
    return bad_input((library_ / "library.sqlite").string(),
                     in_quotes(key) + " in it is not the name of a motion object",
                     next_step());
  }
  const std::filesystem::path file = library_ / recordings::object_path(key, ".npz");
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    return bad_input(file.string(), "the motion of this clip is missing", next_step());
  }
  if (links_ == OuterLinks::kRefuse && !is_inside(file, library_)) {
    return bad_input(file.string(),
                     "a link leads out of the folder of the library",
                     "put the objects themselves into the library");
  }
  auto read = recordings::read_motion_object(file);
  if (!read) {
    Error error = read.error();
    if (error.code == Errc::kBadInput) error.next = next_step();
    return error;
  }
  kept_.push_front({key, std::make_shared<const LibraryMotion>(*std::move(read))});
  std::size_t frames = 0;
  for (auto one = kept_.begin(); one != kept_.end();) {
    frames += one->object->motion.poses.size();
    const bool is_kept = one == kept_.begin() || frames <= kMaxKeptFrames;
    one = is_kept ? std::next(one) : kept_.erase(one);
  }
  return kept_.front().object;
}

Result<LibraryMotion> ClipMotions::read(const ClipRecord& clip) {
  const auto whole = object(clip.object_key);
  if (!whole) return whole.error();
  const Motion& motion = (*whole)->motion;
  const std::int64_t first = std::int64_t{clip.first_frame} - motion.first_frame;
  const std::int64_t last = std::int64_t{clip.last_frame} - motion.first_frame;
  if (first < 0 || last < first || last >= std::ssize(motion.poses)) {
    const std::filesystem::path file =
        library_ / recordings::object_path(clip.object_key, ".npz");
    return bad_input(file.string(),
                     "it does not have the frames " + std::to_string(clip.first_frame) +
                         " to " + std::to_string(clip.last_frame) + " of clip " +
                         clip.clip_id,
                     next_step());
  }
  return library::part_of(**whole, static_cast<int>(first), static_cast<int>(last));
}

}  // namespace marey::app
