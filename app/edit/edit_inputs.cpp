// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_inputs.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <system_error>
#include <utility>
#include <variant>

#include "edit/find/peak_acceleration.h"
#include "edit/render.h"
#include "edit/state/edit_state.h"

#include "app/motion/raw_body.h"
#include "app/motion/read_body.h"
#include "core/base/extension.h"
#include "recordings/base/sha256.h"
#include "recordings/edit/edit_recipe_file.h"
#include "recordings/markers/marker_file.h"
#include "recordings/motion/npz.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxRecipesDeep = 16;

/// Reads the files of a recipe, and those of recipes among its sources.
class EditReader {
 public:
  EditReader(const EditRecipe& recipe,
             ReadEditOptions options,
             std::vector<fs::path> above)
      : recipe_(recipe), options_(std::move(options)), above_(std::move(above)) {}

  Result<EditFiles> read() {
    for (std::size_t i = 0; i < recipe_.sources.size(); ++i) {
      if (const Status ok = read_source(static_cast<int>(i)); !ok) {
        return at_recipe_line_of(ok.error(), recipe_.sources[i].line, options_);
      }
    }
    for (const EditOp& op : recipe_.ops) {
      const auto* retarget = std::get_if<RetargetOp>(&op.parameters);
      if (retarget == nullptr || op.off || out_.avatars.contains(retarget->avatar))
        continue;
      if (const Status ok = read_avatar(retarget->avatar); !ok) {
        return at_recipe_line_of(ok.error(), op.line, options_);
      }
    }
    return std::move(out_);
  }

 private:
  Status read_source(int place) {
    const EditSource& source = recipe_.sources[static_cast<std::size_t>(place)];
    const auto found = find_edit_file(options_, source.path);
    if (!found) return found.error();
    fs::path file = *found;
    std::error_code failed;
    if (fs::is_directory(file, failed)) {
      file /= "motion.npz";
      if (!fs::exists(file, failed)) {
        return bad_input(found->string(),
                         "is a folder without motion.npz",
                         "give a trial's folder of results, or a motion file");
      }
    }
    if (recordings::check_marker_extension(file)) {
      return bad_input(file.string(),
                       "holds labelled markers, not the motion of a body",
                       "solve the markers first (marey fit), and use its motion.npz");
    }
    auto sha256 = recordings::sha256_of_file(file);
    if (!sha256) return sha256.error();
    if (const Status ok = check_edit_source(source, file, *sha256, options_); !ok) {
      return ok;
    }
    out_.sha256.push_back(*sha256);
    out_.paths.push_back(file);
    const bool is_recipe = file.string().ends_with(".edit.toml");
    auto state = is_recipe ? render_source(file, place) : read_motion_source(file, place);
    if (!state) return state.error();
    if (place == 0) {
      out_.source_peak_m_per_s2 = edit::peak_acceleration(state->motion).m_per_s2;
    }
    out_.inputs.sources.insert_or_assign(source.id, *std::move(state));
    return Done{};
  }

  Result<edit::EditState> read_motion_source(const fs::path& file, int place) {
    auto read = read_motion(BodyFile(file));
    if (!read) return read.error();
    for (const std::string& remark : read->remarks) {
      out_.remarks.push_back(file.string() + ": " + remark);
    }
    if (const auto note = left_out(*read)) {
      out_.remarks.push_back(file.string() + ": " + *note);
    }
    if (const auto swapped = assess_exchanged_sides(
            file, read->exchanged, "a .bones.toml file next to the motion")) {
      return swapped->error();
    }
    if (place == 0 && is_gltf(file)) {
      if (auto body = open_avatar(BodyFile(file))) out_.look = std::move(body->look);
    }
    auto state =
        edit::make_edit_state(std::move(read->motion), uncertainty_of(file), place);
    if (state) return state;
    Error error = state.error();
    error.where = file.string() + ": " + error.where;
    return error;
  }

  /// Returns the uncertainty that an .npz holds for all joints; empty: none.
  static std::vector<std::vector<JointUncertainty>> uncertainty_of(const fs::path& file) {
    if (kind_by_extension(file) != ".npz") return {};
    auto uncertainty = recordings::read_npz_uncertainty(file);
    if (!uncertainty) return {};
    return *std::move(uncertainty);
  }

  Result<edit::EditState> render_source(const fs::path& file, int place) {
    std::vector<fs::path> above = above_;
    above.push_back(file);
    std::error_code failed;
    for (const fs::path& open : above_) {
      if (!fs::equivalent(open, file, failed)) continue;
      return bad_input(file.string(),
                       "is a source of itself, through " + above_.back().string(),
                       "remove one of the two sources");
    }
    if (above.size() > kMaxRecipesDeep) {
      return bad_input(file.string(),
                       "is the " + std::to_string(above.size()) +
                           "th recipe that is a source of another",
                       "render one of them with marey edit and use its motion");
    }
    const auto recipe = recordings::read_edit_recipe(file);
    if (!recipe) return recipe.error();
    ReadEditOptions options{
        file.parent_path(), file.string(), options_.accept_new_sources};
    auto files = EditReader(*recipe, options, std::move(above)).read();
    if (!files) return files.error();
    edit::RenderOptions render;
    render.recipe_file = file.string();
    auto rendered = edit::render(*recipe, std::move(files->inputs), render);
    if (!rendered) return rendered.error();
    if (rendered->outputs.size() != 1) {
      return bad_input(file.string(),
                       "gives " + std::to_string(rendered->outputs.size()) + " motions",
                       "use a recipe without keep and split as a source");
    }
    // The result depends on all files of the other recipe.
    for (const std::string& sha256 : files->sha256) out_.sha256.back() += sha256;
    for (const auto& [name, sha256] : files->avatar_sha256) out_.sha256.back() += sha256;
    if (out_.inputs.sources.empty()) out_.look = files->look;
    out_.remarks.insert(out_.remarks.end(), files->remarks.begin(), files->remarks.end());
    out_.paths.insert(out_.paths.end(), files->paths.begin(), files->paths.end());
    // Its frames are the source's own for this recipe.
    edit::EditState state = std::move(rendered->outputs.front());
    const std::vector<edit::FrameLineage> inner = std::move(state.lineage.frames);
    state.lineage = edit::lineage_of_source(place, state.frame_count());
    for (std::size_t t = 0; t < inner.size(); ++t) {
      state.lineage.frames[t].trust = inner[t].trust;
    }
    return state;
  }

  Status read_avatar(const std::string& path) {
    const auto file = find_edit_file(options_, path);
    if (!file) return file.error();
    auto avatar = open_avatar(BodyFile(*file));
    if (!avatar) return avatar.error();
    auto sha256 = recordings::sha256_of_file(*file);
    if (!sha256) return sha256.error();
    out_.paths.push_back(*file);
    for (const std::string& remark : avatar->remarks) {
      out_.remarks.push_back(file->string() + ": " + remark);
    }
    out_.inputs.avatars.emplace(path, avatar->skeleton);
    out_.avatar_sha256.emplace(path, *sha256);
    out_.avatars.emplace(path, *std::move(avatar));
    return Done{};
  }

  const EditRecipe& recipe_;
  ReadEditOptions options_;
  std::vector<fs::path> above_;  ///< Recipes that are being read.
  EditFiles out_;
};

}  // namespace

Result<EditFiles> read_edit_files(const EditRecipe& recipe,
                                  const ReadEditOptions& options) {
  std::vector<fs::path> above;
  if (!options.recipe_file.empty()) above.emplace_back(options.recipe_file);
  return EditReader(recipe, options, std::move(above)).read();
}

std::vector<std::string> edit_keys(const EditRecipe& recipe, const EditFiles& files) {
  std::string key;
  for (std::size_t i = 0; i < recipe.sources.size(); ++i) {
    key += recipe.sources[i].id + "=" + files.sha256[i] + "\n";
  }
  for (const auto& [path, sha256] : files.avatar_sha256)
    key += path + "=" + sha256 + "\n";
  std::vector<std::string> out;
  for (const EditOp& op : recipe.ops) {
    key = recordings::sha256(key + recordings::edit_op_text(op));
    out.push_back(key);
  }
  return out;
}

}  // namespace marey::app
