// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/page/library_page_server.h"

#include <algorithm>
#include <system_error>
#include <type_traits>
#include <utility>
#include <variant>

#include "app/library/check/failed_source.h"
#include "app/library/page/clip_scene.h"
#include "app/library/page/page_corrections.h"
#include "live/page/page_scene.h"
#include "recordings/library/library_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

constexpr int kNeighbours = 3;
constexpr std::size_t kKeptScenes = 12;
constexpr std::size_t kMaxDrawings = 4096;

double row_time_s(const ClipRecord& clip, int row) {
  return first_row_s(clip.first_frame, clip.rate_hz) + 0.1 * row;
}

}  // namespace

LibraryPageServer::LibraryPageServer(fs::path library,
                                     std::string query,
                                     live::WebServer& server)
    : library_(std::move(library)),
      server_(server),
      motions_(library_, OuterLinks::kRefuse) {
  state_.query = std::move(query);
  state_.folder = library_.string();
  open();
}

LibraryPageServer::Stamp LibraryPageServer::stamp() const {
  Stamp out;
  std::error_code ignored;  // A missing file has the zero stamp.
  const fs::path index = library_ / "library.sqlite";
  const auto time = fs::last_write_time(index, ignored);
  if (!ignored) out.index = time;
  const auto bytes = fs::file_size(index, ignored);
  if (!ignored) out.index_bytes = bytes;
  return out;
}

void LibraryPageServer::open() {
  stamp_ = stamp();
  listing_.reset();
  neighbours_.reset();
  neighbour_trouble_.clear();
  drawings_.clear();
  motions_ = ClipMotions(library_, OuterLinks::kRefuse);
  ++state_.revision;
  state_.clips = 0;
  state_.trouble.clear();
  // A report that cannot be read hides no clip: `marey library check` states the reason.
  const auto failed = read_failed_sources(library_);
  state_.failed = failed ? static_cast<int>(failed->size()) : 0;
  const auto settings = recordings::read_library(library_ / "library.toml");
  state_.name =
      settings && !settings->name.empty() ? settings->name : library_.filename().string();
  limits_ =
      library::QualityLimits(settings ? std::span<const QualityLimit>(settings->limits)
                                      : std::span<const QualityLimit>());
  std::error_code ignored;
  if (!fs::exists(library_ / "library.sqlite", ignored)) {
    state_.trouble = "This library has not been built. Next: run marey library build " +
                     library_.string() + ".";
  } else {
    auto listing = ClipListing::open(library_);
    if (listing) {
      listing_.emplace(*std::move(listing));
      state_.clips = listing_->size();
    } else {
      state_.trouble = listing.error().message();
    }
  }
  if (listing_ && listing_->size() > 0) {
    auto neighbours = ClipNeighbours::open(library_, listing_->size());
    if (neighbours) {
      neighbours_.emplace(*std::move(neighbours));
    } else {
      neighbour_trouble_ = neighbours.error().message();
    }
  }
  // In the place of a scene, so that a new page gets it first.
  server_.publish_text(live::PageMessage::kScene, library_page_json(state_));
}

void LibraryPageServer::look() {
  if (stamp() != stamp_) open();
}

Result<std::vector<ClipRecord>> LibraryPageServer::records(
    std::vector<int> numbers) const {
  auto out = recordings::read_library_records(library_ / "library.sqlite", numbers);
  if (!out) return out;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if ((*out)[i].clip_id == (*listing_)[numbers[i]].clip_id) continue;
    return bad_input(
        "library.sqlite", "the library was built again meanwhile", "load the list again");
  }
  return out;
}

LibraryPageServer::Answer LibraryPageServer::list(
    const LibraryAsker& asker, const live::LibraryListRequest& request) {
  const auto found = listing_->find(request);
  if (!found) return found.error();
  const std::vector<int>& numbers = (*found)->numbers;
  const auto first = std::min(static_cast<std::size_t>(request.offset), numbers.size());
  const auto count =
      std::min(static_cast<std::size_t>(request.count), numbers.size() - first);
  return clips_json(asker,
                    *listing_,
                    **found,
                    request.offset,
                    std::span(numbers).subspan(first, count));
}

/// Draws clips that have no drawing yet. A clip without a motion gets an empty one.
void LibraryPageServer::add_drawings(const std::vector<int>& numbers) {
  if (drawings_.size() + numbers.size() > kMaxDrawings) drawings_.clear();
  std::vector<int> missing;
  for (const int number : numbers) {
    if (!drawings_.contains(number)) missing.push_back(number);
  }
  if (missing.empty()) return;
  const auto clips = records(missing);
  for (std::size_t i = 0; i < missing.size(); ++i) {
    std::string& drawing = drawings_[missing[i]];
    drawing = missing_drawing_json(missing[i]);
    if (!clips) continue;
    const auto motion = motions_.read((*clips)[i]);
    if (motion) drawing = drawing_json(missing[i], draw_clip(motion->motion));
  }
}

LibraryPageServer::Answer LibraryPageServer::draw(
    const LibraryAsker& asker, const live::LibraryPosesRequest& request) {
  for (const int clip : request.clips) {
    if (clip >= listing_->size()) {
      return bad_input("clips", "there is no such clip", "load the list again");
    }
  }
  add_drawings(request.clips);
  std::vector<std::string> drawings;
  for (const int clip : request.clips) drawings.push_back(drawings_[clip]);
  return drawings_json(asker, drawings);
}

/// Serves the media of a scene, and removes those of the oldest one.
void LibraryPageServer::serve(PageOfRecording page) {
  std::vector<std::string>& paths = served_.emplace_back();
  for (live::WebContent& content : page.media) {
    paths.push_back(content.path);
    server_.put(std::move(content));
  }
  media_number_ += paths.size();
  if (served_.size() <= kKeptScenes) return;
  for (const std::string& path : served_.front()) server_.remove(path);
  served_.pop_front();
}

/// Makes the scene of a clip and its neighbours.
void LibraryPageServer::add_neighbours(const live::LibraryClipRequest& request,
                                       const LibraryMotion& motion,
                                       ShownClip& shown) {
  std::vector<ComparedMotion> others;
  FoundNeighbours found;
  if (neighbours_) {
    found = neighbours_->find(request.clip, request.is_mirrored, kNeighbours);
  }
  shown.compared_s = std::max(0.0, 0.1 * (found.compared_rows - 1));
  std::vector<int> numbers;
  for (const ClipNeighbour& one : found.clips) numbers.push_back(one.clip);
  const auto clips = numbers.empty() ? std::vector<ClipRecord>() : records(numbers);
  if (!clips) {
    shown.neighbour_trouble = clips.error().message();
    found.clips.clear();
  }
  for (std::size_t i = 0; i < found.clips.size(); ++i) {
    const ClipRecord& clip = (*clips)[i];
    ShownNeighbour one;
    one.neighbour = found.clips[i];
    one.start_s = row_time_s(clip, one.neighbour.first_row);
    one.end_s = row_time_s(clip, one.neighbour.last_row);
    auto read = motions_.read(clip);
    if (read && !read->motion.poses.empty()) {
      others.push_back({clip.name, std::move(read->motion), one.start_s, one.end_s});
    } else if (!read) {
      one.trouble = read.error().message();
    }
    shown.neighbours.push_back(std::move(one));
  }
  auto scene = make_clip_scene(
      shown.record.name, motion.motion, shown.compared_s, others, media_number_ + 1);
  if (!scene) {
    shown.trouble = scene.error().message();
    return;
  }
  shown.frame_step = scene->frame_step;
  shown.scene = live::scene_json(scene->page.scene);
  serve(std::move(scene->page));
}

LibraryPageServer::Answer LibraryPageServer::show(
    const LibraryAsker& asker, const live::LibraryClipRequest& request) {
  if (request.clip >= listing_->size()) {
    return bad_input("clip", "there is no such clip", "load the list again");
  }
  const auto clips = records({request.clip});
  if (!clips) return clips.error();
  ShownClip shown{.record = clips->front(),
                  .number = request.clip,
                  .scene = {},
                  .trouble = {},
                  .is_mirrored = request.is_mirrored,
                  .neighbours = {},
                  .neighbour_trouble = neighbour_trouble_};
  const auto motion = motions_.read(clips->front());
  if (motion) {
    add_neighbours(request, *motion, shown);
  } else {
    shown.trouble = motion.error().message();
  }
  return shown_clip_json(asker, shown, *listing_, limits_);
}

LibraryPageServer::Answer LibraryPageServer::store(
    const LibraryAsker& asker, const live::LibraryVerdictRequest& request) {
  if (!listing_->find(request.clip_id)) {
    return bad_input(request.clip_id, "there is no such clip", "load the list again");
  }
  if (const Status ok = store_verdict(library_, request); !ok) return ok.error();
  return stored_json(asker, kVerdictTable);
}

LibraryPageServer::Answer LibraryPageServer::store(
    const LibraryAsker& asker, const live::LibraryLabelRequest& request) {
  if (!listing_->find(request.clip_id)) {
    return bad_input(request.clip_id, "there is no such clip", "load the list again");
  }
  if (const Status ok = store_label(library_, request); !ok) return ok.error();
  return stored_json(asker, kLabelTable);
}

/// Returns the answer; empty: none.
LibraryPageServer::Answer LibraryPageServer::carry_out(
    const LibraryAsker& asker, const live::LibraryPageRequest& request) {
  return std::visit(
      [&](const auto& body) -> Answer {
        using Body = std::decay_t<decltype(body)>;
        if constexpr (std::is_same_v<Body, live::LibraryListRequest>) {
          return list(asker, body);
        } else if constexpr (std::is_same_v<Body, live::LibraryPosesRequest>) {
          return draw(asker, body);
        } else if constexpr (std::is_same_v<Body, live::LibraryClipRequest>) {
          return show(asker, body);
        } else if constexpr (std::is_same_v<Body, live::HelloRequest>) {
          return std::string();
        } else {
          return store(asker, body);
        }
      },
      request.body);
}

void LibraryPageServer::answer(const live::ReceivedText& text) {
  LibraryAsker asker;
  asker.revision = state_.revision;
  const auto request = live::read_library_request(text.text);
  if (!request) {
    server_.queue_text(text.client, library_error_json(asker, request.error().message()));
    return;
  }
  asker.about = request->type;
  asker.id = request->id;
  if (std::holds_alternative<live::HelloRequest>(request->body)) return;
  if (request->revision != state_.revision) {
    server_.queue_text(text.client, outdated_json(asker));
    return;
  }
  if (!listing_) {
    server_.queue_text(text.client, library_error_json(asker, state_.trouble));
    return;
  }
  const Answer answer = carry_out(asker, *request);
  server_.queue_text(
      text.client,
      answer ? *answer : library_error_json(asker, answer.error().message()));
}

}  // namespace marey::app
