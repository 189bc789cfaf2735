// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/jump/jump_options.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

#include <glm/vec3.hpp>

#include "app/motion/motion_files.h"
#include "app/motion/raw_body.h"
#include "app/shell/option_checks.h"
#include "core/base/in_quotes.h"
#include "recordings/edit/edit_limits.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
namespace recipe = recordings::recipe;

constexpr double kCmPerM = 100.0;

/// Returns the range of a key of recipes, in another unit.
CLI::Validator within(const recordings::Limits& limits, double per_unit = 1.0) {
  return between(limits.low * per_unit, limits.high * per_unit);
}

/// Reads "X,Y,Z" in metres; nullopt: the text has another form, or a number is out of
/// range.
std::optional<glm::dvec3> place_of_text(std::string_view text) {
  glm::dvec3 place(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t comma = text.find(',');
    if ((comma == std::string_view::npos) != (axis == 2)) return std::nullopt;
    const std::string_view word = text.substr(0, comma);
    double value = 0.0;
    const char* const last = word.data() + word.size();
    const auto [end, problem] = std::from_chars(word.data(), last, value);
    const bool is_number = problem == std::errc{} && end == last && std::isfinite(value);
    if (!is_number || value < recipe::kPlace.low || value > recipe::kPlace.high) {
      return std::nullopt;
    }
    place[axis] = value;
    if (axis < 2) text.remove_prefix(comma + 1);
  }
  return place;
}

CLI::Validator place_check() {
  return {[](std::string& text) -> std::string {
            if (place_of_text(text)) return {};
            return "must be three numbers from -10000 to 10000 with commas between "
                   "them, X,Y,Z in metres, not " +
                   in_quotes(text);
          },
          "X,Y,Z"};
}

void add_wishes(CLI::App& command, JumpArguments& args) {
  CLI::Option* raise =
      command.add_option("--apex-by",
                         args.apex_by_cm,
                         "Raises the highest point of the centre of mass [cm]");
  raise->check(within(recipe::kJumpRaise, kCmPerM));
  command
      .add_option("--apex",
                  args.apex_m,
                  "Highest point of the centre of mass above the take-off's floor [m]")
      ->check(within(recipe::kJumpApex))
      ->excludes(raise);
  command.add_option("--airtime", args.airtime_s, "Time from take-off to touch-down [s]")
      ->check(within(recipe::kJumpAirtime));
  CLI::Option* length = command.add_option(
      "--length", args.length_m, "Distance between take-off and landing [m]");
  length->check(within(recipe::kJumpLength));
  CLI::Option* box = command.add_option(
      "--box", args.box_cm, "Height of the landing's floor above the take-off's [cm]");
  box->check(within(recipe::kJumpBox, kCmPerM));
  command
      .add_option(
          "--land", args.landing_m, "Middle of the soles at landing, in the world [m]")
      ->check(place_check())
      ->excludes(length)
      ->excludes(box);
}

void add_push(CLI::App& command, JumpArguments& args) {
  command.add_option("--push-time", args.push_s, "Duration of the push [s]")
      ->check(within(recipe::kJumpPush));
  command
      .add_option("--push-start",
                  args.push_start_s,
                  "Start of the push in MOTION, if the detected one is wrong [s]")
      ->check(within(recipe::kTime));
  command
      .add_option("--law",
                  args.law,
                  "Course of the push: the captured push with the smallest correction "
                  "(force), or a polynomial of degree 7 (thesis); default force")
      ->check(one_of({"force", "thesis"}));
  command
      .add_option("--strength",
                  args.strength_g,
                  "Largest vertical push [g]; default 1.3 times the captured peak, at "
                  "least 2.5")
      ->check(within(recipe::kStrength));
  command
      .add_option(
          "--gravity", args.gravity_m_s2, "Gravity of the result [m/s^2]; default 9.81")
      ->check(within(recipe::kGravity));
}

/// Returns the option of a key of the operation; other words unchanged.
std::string option_of_key(const std::string& key) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 10> kOptions{
      {{"apex_m", "--apex"},
       {"apex_by_m", "--apex-by"},
       {"airtime_s", "--airtime"},
       {"length_m", "--length"},
       {"land_m", "--land"},
       {"box_m", "--box"},
       {"push_s", "--push-time"},
       {"push_start", "--push-start"},
       {"strength_g", "--strength"},
       {"gravity_m_s2", "--gravity"}}};
  for (const auto& [name, option] : kOptions) {
    if (key == name) return std::string(option);
  }
  return key;
}

}  // namespace

void add_jump_options(CLI::App& command, JumpArguments& args) {
  command.add_option("MOTION", args.motion, "Motion: " + body_extensions())->required();
  command.add_option("-o,--out", args.out, "Result: " + motion_extensions())->required();
  command.add_option("-c,--character",
                     args.character,
                     "character.toml of the body and its masses; default the motion's "
                     "body with an adult's masses");
  command
      .add_option("--jump", args.jump, "Number of the jump in MOTION, from 1; default 1")
      ->check(whole_between(static_cast<long>(recipe::kJumpNumber.low),
                            static_cast<long>(recipe::kJumpNumber.high)));
  add_wishes(command, args);
  add_push(command, args);
  command.add_flag("--ballistic",
                   args.ballistic,
                   "Moves the centre of mass of the captured flight onto a parabola");
  const std::string keep_help = "Keeps the angular momentum in flight constant (default)";
  CLI::Option* keep = command.add_flag("--keep-momentum", keep_help);
  command
      .add_flag("--no-keep-momentum",
                args.drop_momentum,
                "Leaves the angular momentum in flight as it is")
      ->excludes(keep);
  command.add_flag("--json", args.json, "Print the figures as JSON on standard output");
}

EditRecipe jump_recipe(const JumpArguments& args) {
  JumpOp op;
  op.jump = args.jump;
  op.apex_m = args.apex_m;
  if (args.apex_by_cm) op.apex_by_m = *args.apex_by_cm / kCmPerM;
  op.airtime_s = args.airtime_s;
  op.length_m = args.length_m;
  op.landing_in_world = place_of_text(args.landing_m);
  if (args.box_cm) op.box_m = *args.box_cm / kCmPerM;
  op.push_s = args.push_s;
  if (args.push_start_s) op.push_start = AtTime{*args.push_start_s};
  op.law = args.law == "thesis" ? EditPushLaw::kThesis : EditPushLaw::kForce;
  op.strength_g = args.strength_g;
  op.gravity_m_s2 = args.gravity_m_s2;
  op.ballistic = args.ballistic;
  op.keep_momentum = !args.drop_momentum;
  EditRecipe out;
  out.name = args.out.stem().string();
  std::error_code failed;
  EditSource source;
  source.path = fs::absolute(args.motion, failed).string();
  out.sources.push_back(std::move(source));
  EditOp edit;
  edit.parameters = op;
  out.ops.push_back(std::move(edit));
  return out;
}

std::string with_jump_options(const std::string& text) {
  std::string out;
  std::string word;
  // The end of the text closes the last word.
  for (std::size_t i = 0; i <= text.size(); ++i) {
    const char c = i < text.size() ? text[i] : ' ';
    const bool in_word = c == '_' || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (in_word) {
      word += c;
      continue;
    }
    out += option_of_key(word);
    word.clear();
    if (i < text.size()) out += c;
  }
  const std::string_view law = "law = \"";
  const std::size_t found = out.find(law);
  if (found == std::string::npos) return out;
  const std::size_t quote = out.find('"', found + law.size());
  if (quote != std::string::npos) out.erase(quote, 1);
  return out.replace(found, law.size(), "--law ");
}

}  // namespace marey::app
