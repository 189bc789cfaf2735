// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/source_id.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

#include <nlohmann/json.hpp>

#include "app/edit/edit_source_file.h"
#include "app/library/sources/source_kind.h"
#include "core/base/extension.h"
#include "recordings/base/sha256.h"
#include "recordings/body/bone_map_file.h"
#include "recordings/edit/edit_recipe_file.h"
#include "recordings/motion/asf.h"
#include "recordings/session/session.h"
#include "recordings/takes/take_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPartsDeep = 16;

/// Returns the JSON of a .gltf, or of the first chunk of a binary glTF; empty: neither.
std::string gltf_document(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  constexpr std::size_t kHeaderBytes = 20;
  std::string text(kHeaderBytes, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  std::error_code failed;
  const std::uintmax_t size = fs::file_size(path, failed);
  if (failed) return {};
  std::size_t rest = static_cast<std::size_t>(size) - text.size();
  if (text.starts_with("glTF")) {
    if (text.size() < kHeaderBytes) return {};
    std::uint32_t chunk = 0;
    std::memcpy(&chunk, text.data() + 12, sizeof(chunk));
    rest = std::min<std::size_t>(rest, chunk);
    text.clear();
  }
  const std::size_t begin = text.size();
  text.resize(begin + rest);
  in.read(text.data() + begin, static_cast<std::streamsize>(rest));
  text.resize(begin + static_cast<std::size_t>(in.gcount()));
  return text;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Returns a URI's path: "%20" is a blank.
std::string decoded_uri(std::string_view uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool is_escape = uri[i] == '%' && i + 2 < uri.size() &&
                           hex_digit(uri[i + 1]) >= 0 && hex_digit(uri[i + 2]) >= 0;
    if (!is_escape) {
      out += uri[i];
      continue;
    }
    out += static_cast<char>(16 * hex_digit(uri[i + 1]) + hex_digit(uri[i + 2]));
    i += 2;
  }
  return out;
}

/// Collects the parts of one source and the text that its id is made of.
class PartCollector {
 public:
  Result<IdentifiedSource> identify(const SourceFile& source) {
    const bool is_session = source.kind == kSessionKind;
    const Status ok = is_session ? add_session(source.path) : add_file(source.path);
    if (!ok) return ok.error();
    IdentifiedSource out;
    const bool is_single = parts_.files.size() == 1 && !is_session;
    out.id = is_single ? first_sha256_ : recordings::sha256(text_);
    std::ranges::sort(parts_.absent);
    const auto [same, end] = std::ranges::unique(parts_.absent);
    parts_.absent.erase(same, end);
    out.parts = std::move(parts_);
    return out;
  }

 private:
  /// Adds a file, whatever it is.
  Status add(std::string_view role, const fs::path& path) {
    auto sha256 = recordings::sha256_of_file(path);
    if (!sha256) return sha256.error();
    if (parts_.files.empty()) first_sha256_ = *sha256;
    text_ += std::string(role) + "\n" + *sha256 + "\n";
    parts_.files.push_back(path);
    return Done{};
  }

  /// Adds a file, if it exists.
  Status add_if_there(std::string_view role, const fs::path& path) {
    std::error_code failed;
    if (fs::is_regular_file(path, failed)) return add(role, path);
    parts_.absent.push_back(path);
    return Done{};
  }

  /// Adds a source that is a file, with all that its reader uses.
  Status add_file(const fs::path& path) {
    if (const Status ok = add("source", path); !ok) return ok;
    const std::string kind = source_kind(path);
    if (kind == kRecipeKind) return add_recipe(path);
    const fs::path folder = path.parent_path();
    if (kind == "c3d" || kind == "trc") {
      const Status ok = add_if_there("subject", folder / kMarkerSubjectFile);
      return ok ? add_if_there("labels", folder / kMarkerMapFile) : ok;
    }
    if (kind == "amc") {
      const auto skeleton = recordings::find_skeleton_file(path);
      const Status ok = skeleton ? add("skeleton", *skeleton) : Status(Done{});
      if (!ok) return ok;
      // A skeleton of this name would be used instead.
      const fs::path own = fs::path(path).replace_extension(".asf");
      if (skeleton != own) parts_.absent.push_back(own);
    }
    if (kind == "glb" || kind == "gltf" || kind == "vrm" || kind == "vrma") {
      if (const Status ok = add_buffers(path); !ok) return ok;
    }
    return add_if_there("bones", recordings::bone_map_path(path));
  }

  Status add_buffers(const fs::path& path) {
    const auto document =
        nlohmann::json::parse(gltf_document(path), nullptr, /*allow_exceptions=*/false);
    if (!document.is_object()) return Done{};
    const auto buffers = document.find("buffers");
    if (buffers == document.end() || !buffers->is_array()) return Done{};
    for (const auto& buffer : *buffers) {
      if (!buffer.is_object()) continue;
      const auto uri = buffer.find("uri");
      if (uri == buffer.end() || !uri->is_string()) continue;
      const auto& text = uri->get_ref<const std::string&>();
      if (text.starts_with("data:")) continue;
      const Status ok = add_if_there("buffer", path.parent_path() / decoded_uri(text));
      if (!ok) return ok;
    }
    return Done{};
  }

  /// Adds sources and avatars of a recipe, and those of recipes among them.
  Status add_recipe(const fs::path& path) {
    const auto recipe = recordings::read_edit_recipe(path);
    if (!recipe || ++depth_ > kMaxPartsDeep) return Done{};
    const ReadEditOptions options{path.parent_path(), path.string(), false};
    std::vector<std::string> stated;
    for (const EditSource& source : recipe->sources) stated.push_back(source.path);
    for (const EditOp& op : recipe->ops) {
      const auto* retarget = std::get_if<RetargetOp>(&op.parameters);
      if (retarget != nullptr && !op.off) stated.push_back(retarget->avatar);
    }
    for (const std::string& name : stated) {
      auto file = find_edit_file(options, name);
      if (!file) {
        parts_.absent.push_back(path.parent_path() / name);
        continue;
      }
      std::error_code failed;
      if (fs::is_directory(*file, failed)) *file /= "motion.npz";
      if (!fs::is_regular_file(*file, failed)) {
        parts_.absent.push_back(*file);
      } else if (const Status ok = add_file(*file); !ok) {
        return ok;
      }
    }
    --depth_;
    return Done{};
  }

  /// Adds a file of a session by its path in the session's folder. It is part of the id,
  /// because camera and trial of a video follow from it.
  Status add_by_name(const fs::path& folder, const fs::path& path) {
    const fs::path below = path.lexically_relative(folder);
    const bool is_below = !below.empty() && *below.begin() != "..";
    const std::string name = (is_below ? below : path.filename()).generic_string();
    std::error_code failed;
    if (!known_.insert(path).second) return Done{};
    if (!fs::is_directory(path, failed)) return add_if_there(name, path);
    std::vector<fs::path> images;
    for (fs::directory_iterator at(path, failed), end; !failed && at != end;
         at.increment(failed)) {
      std::error_code unknown;
      if (at->is_regular_file(unknown)) images.push_back(at->path());
    }
    std::ranges::sort(images);
    for (const fs::path& image : images) {
      const Status ok = add(name + "/" + image.filename().string(), image);
      if (!ok) return ok;
    }
    return Done{};
  }

  Status add_session(const fs::path& path) {
    std::error_code failed;
    const bool is_folder = fs::is_directory(path, failed);
    const fs::path file = is_folder ? path / kSessionFile : path;
    if (const Status ok = add("session", file); !ok) return ok;
    const auto session = recordings::read_session(path);
    if (!session) return Done{};
    const fs::path folder = file.parent_path();
    std::vector<fs::path> all;
    if (session->calibration.lenses) all.push_back(*session->calibration.lenses);
    for (const recordings::Trial& trial : session->trials) {
      for (const recordings::TrialVideo& video : trial.videos) all.push_back(video.path);
      if (trial.timestamps) all.push_back(*trial.timestamps);
      if (trial.videos.empty()) continue;
      const fs::path take =
          trial.videos.front().path.parent_path() / recordings::kTakeFile;
      all.push_back(take);
      // Frames of a recording that was interrupted.
      all.push_back(take.string() + "-wal");
    }
    for (const fs::path& one : all) {
      if (const Status ok = add_by_name(folder, one); !ok) return ok;
    }
    return Done{};
  }

  SourceParts parts_;
  std::string text_;
  std::string first_sha256_;
  std::set<fs::path> known_;
  std::size_t depth_ = 0;
};

}  // namespace

Result<IdentifiedSource> identify_source(const SourceFile& source) {
  return PartCollector().identify(source);
}

}  // namespace marey::app
