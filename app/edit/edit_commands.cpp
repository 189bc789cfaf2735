// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_commands.h"

#include <cstdio>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/edit/edit_batch.h"
#include "app/edit/edit_inputs.h"
#include "app/edit/edit_json.h"
#include "app/edit/edit_outputs.h"
#include "app/edit/edit_run.h"
#include "app/edit/marker_edit_run.h"
#include "app/motion/raw_body.h"
#include "app/shell/findings.h"
#include "app/shell/option_checks.h"
#include "app/view/view_commands.h"
#include "core/base/format_text.h"
#include "core/base/in_quotes.h"
#include "recordings/base/sha256.h"
#include "recordings/edit/edit_recipe_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Records the content of the sources in the recipe.
Status pin_sources(const fs::path& file,
                   const std::vector<std::string>& sha256,
                   EditRecipe& recipe) {
  for (std::size_t i = 0; i < recipe.sources.size(); ++i) {
    recipe.sources[i].sha256 = sha256[i].substr(0, 64);
  }
  return recordings::write_edit_recipe(file, recipe);
}

/// Reads the source of a new recipe, and returns its SHA-256.
Result<std::string> sha256_of_first_source(const EditRecipe& recipe,
                                           const ReadEditOptions& options) {
  if (edits_markers(recipe, options)) {
    const auto markers = read_marker_edit_files(recipe, options);
    if (!markers) return markers.error();
    return markers->sha256;
  }
  const auto files = read_edit_files(recipe, options);
  if (!files) return files.error();
  return files->sha256.front();
}

/// Checks the file of a new recipe, and that its source exists.
Status check_new_recipe(const EditArguments& args) {
  if (const Status ok = check_out_file(args.new_recipe); !ok) return ok;
  std::error_code failed;
  if (fs::exists(args.new_recipe, failed)) {
    return bad_input(args.new_recipe.string(),
                     "exists already",
                     "give another name, or edit that recipe");
  }
  if (!args.new_recipe.string().ends_with(".edit.toml")) {
    return bad_usage("--new",
                     in_quotes(args.new_recipe.string()) + " is no name of a recipe",
                     "give one that ends with .edit.toml");
  }
  const fs::path folder = fs::absolute(args.new_recipe, failed).parent_path();
  if (!fs::is_directory(folder, failed)) {
    return bad_input(args.new_recipe.string(),
                     "its folder does not exist",
                     "make the folder, or choose another");
  }
  if (fs::exists(args.recipe, failed)) return Done{};
  return bad_input(
      args.recipe.string(), "the file does not exist", "check the name and the folder");
}

Exit make_recipe(const EditArguments& args, Console& console) {
  if (const Status ok = check_new_recipe(args); !ok) return console.fail(ok.error());
  std::error_code failed;
  EditRecipe recipe;
  recipe.name = args.recipe.stem().string();
  EditSource source;
  const fs::path folder = fs::absolute(args.new_recipe, failed).parent_path();
  source.path = fs::relative(fs::absolute(args.recipe, failed), folder, failed).string();
  if (source.path.empty()) source.path = fs::absolute(args.recipe, failed).string();
  recipe.sources.push_back(source);
  const auto sha256 = sha256_of_first_source(recipe, {folder, {}, false});
  if (!sha256) return console.fail(sha256.error());
  recipe.sources.front().sha256 = sha256->substr(0, 64);
  const Status ok = recordings::write_edit_recipe(args.new_recipe, recipe);
  if (!ok) return console.fail(ok.error());
  console.say("recipe: " + args.new_recipe.string());
  return Exit::kOk;
}

std::vector<Finding> findings_of(const EditRun& run,
                                 const std::vector<EditFigures>& figures) {
  std::vector<Finding> out;
  for (const std::string& remark : run.files.remarks) {
    Finding note;
    note.cause = remark;
    out.push_back(note);
  }
  for (const edit::OpReport& report : run.rendered.reports) {
    for (Finding finding : report.findings) {
      const std::string place =
          "operation " + std::to_string(report.index + 1) + " (" + report.name + ")";
      const bool names_op =
          finding.where.empty() || report.name.starts_with(finding.where + "@");
      finding.where = names_op ? place : place + ": " + finding.where;
      out.push_back(std::move(finding));
    }
  }
  for (Finding& finding : assess_edit(run.recipe, figures)) {
    out.push_back(std::move(finding));
  }
  return out;
}

void say_figures(const std::vector<EditFigures>& figures, Console& console) {
  for (const EditFigures& f : figures) {
    console.say(format_text(
        "%s: %d frames, %.2f s; standing feet drift %.2f mm at most; joints displaced "
        "%.0f mm at most; %d frames invented",
        f.name.c_str(),
        f.frames,
        f.duration_s,
        f.slide_mm,
        f.displaced_mm,
        f.inferred_frames));
  }
}

void say_marker_figures(const MarkerEditRun& run, Console& console) {
  for (std::size_t i = 0; i < run.figures.size(); ++i) {
    const EditFigures& f = run.figures[i];
    console.say(format_text(
        "%s: %d frames, %.2f s, %zu markers, displaced %.2f mm at most; %d frames "
        "invented",
        f.name.c_str(),
        f.frames,
        f.duration_s,
        run.rendered.outputs[i].tracks.markers(),
        f.displaced_mm,
        f.inferred_frames));
  }
}

/// Sets the formats of the results.
Status set_formats(const EditArguments& args, EditOutput& output) {
  for (const std::string& word : args.formats) {
    const auto format = motion_format(word);
    if (format) {
      output.formats.push_back(*format);
    } else if (word == name(MarkerFormat::kC3d)) {
      output.marker_formats.push_back(MarkerFormat::kC3d);
    } else if (word == name(MarkerFormat::kTrc)) {
      output.marker_formats.push_back(MarkerFormat::kTrc);
    } else {
      return bad_usage("--format",
                       in_quotes(word) + " is no format of a motion or of markers",
                       "choose one of " + motion_extensions() +
                           " for a motion, c3d or trc for labelled markers");
    }
  }
  return Done{};
}

Exit edit_many(const EditArguments& args, const EditOutput& output, Console& console) {
  const auto recipe = read_named_recipe(args.recipe);
  if (!recipe) return console.fail(recipe.error());
  const auto motions = files_of_pattern(args.each);
  if (!motions) return console.fail(motions.error());
  return run_edit_batch(
      *recipe, args.recipe, *motions, output, {run_options(args), args.check}, console);
}

Exit serve_recipe(const EditArguments& args,
                  const std::vector<MotionFormat>& formats,
                  Console& console) {
  EditPageArguments page = args.page;
  page.what = args.recipe;
  page.out = args.out;
  page.formats = formats;
  page.accept_new_source = args.accept_new_source;
  return run_edit_page(page, console);
}

Exit edit_one_motion(EditRecipe recipe,
                     const EditArguments& args,
                     const EditOutput& output,
                     Console& console) {
  auto run = render_recipe(args.recipe, std::move(recipe), run_options(args), console);
  if (!run) return console.fail(run.error());
  const auto figures = measure_edit(run->recipe, run->files, run->rendered);
  const auto findings = findings_of(*run, figures);
  if (args.json)
    print_edit_json(edit_json(run->recipe, run->files, run->rendered, figures));
  if (!args.check) {
    const auto written =
        write_edit(run->recipe, run->files, run->rendered, figures, output);
    if (!written) return console.fail(written.error());
  }
  print_warnings(console, findings);
  say_figures(figures, console);
  if (args.pin) {
    const Status ok = pin_sources(args.recipe, run->files.sha256, run->recipe);
    if (!ok) return console.fail(ok.error());
  }
  return print_failures(console, findings);
}

Exit edit_one_recording(EditRecipe recipe,
                        const EditArguments& args,
                        const EditOutput& output,
                        Console& console) {
  auto run =
      render_marker_recipe(args.recipe, std::move(recipe), run_options(args), console);
  if (!run) return console.fail(run.error());
  const auto findings = findings_of_marker_edit(*run, output);
  if (args.json) {
    print_edit_json(
        marker_edit_json(run->recipe, run->files, run->rendered, run->figures));
  }
  if (!args.check) {
    const auto written =
        write_marker_edit(run->recipe, run->files, run->rendered, run->figures, output);
    if (!written) return console.fail(written.error());
  }
  print_warnings(console, findings);
  say_marker_figures(*run, console);
  if (args.pin) {
    const Status ok = pin_sources(args.recipe, {run->files.sha256}, run->recipe);
    if (!ok) return console.fail(ok.error());
  }
  return print_failures(console, findings);
}

Exit edit_one_recipe(const EditArguments& args,
                     const EditOutput& output,
                     Console& console) {
  auto recipe = read_named_recipe(args.recipe);
  if (!recipe) return console.fail(recipe.error());
  const bool has_markers =
      edits_markers(*recipe, options_of_reading(args.recipe, run_options(args)));
  const Status ok = check_output_formats(output, has_markers);
  if (!ok) return console.fail(ok.error());
  return has_markers ? edit_one_recording(*std::move(recipe), args, output, console)
                     : edit_one_motion(*std::move(recipe), args, output, console);
}

}  // namespace

EditRunOptions run_options(const EditArguments& args) {
  EditRunOptions out;
  out.accept_new_sources = args.accept_new_source;
  if (args.until) out.until = static_cast<std::size_t>(*args.until);
  return out;
}

Exit run_edit(const EditArguments& args, Console& console) {
  if (!args.new_recipe.empty()) return make_recipe(args, console);
  if (args.out.empty() && !args.check && !args.serves_page) {
    return console.fail(
        bad_usage("--out",
                  "is missing",
                  "give a folder for the results, or use --page or --check"));
  }
  EditOutput output;
  output.out = args.out;
  if (const Status ok = set_formats(args, output); !ok) return console.fail(ok.error());
  if (!args.out.empty()) {
    if (const Status ok = check_out_folder(args.out); !ok)
      return console.fail(ok.error());
  }
  if (args.serves_page) {
    // The page edits no markers.
    if (const Status ok = check_output_formats(output, false); !ok) {
      return console.fail(ok.error());
    }
    return serve_recipe(args, output.formats, console);
  }
  return args.each.empty() ? edit_one_recipe(args, output, console)
                           : edit_many(args, output, console);
}

namespace {

/// Options of the page need --page. Options that write or measure exclude it, and the
/// making of a recipe. A batch has no single source to record and no single result to
/// print.
void relate_edit_options(CLI::App& command, EditArguments& args) {
  CLI::Option* page = command.add_flag(
      "--page",
      args.serves_page,
      "Edits in a browser; a motion gets the recipe NAME.edit.toml next to it");
  for (const char* other : {"--until", "--each", "--new", "--check", "--pin", "--json"}) {
    page->excludes(command.get_option(other));
  }
  CLI::Option* new_recipe = command.get_option("--new");
  for (const char* other : {"--out", "--until", "--each", "--check", "--pin", "--json"}) {
    new_recipe->excludes(command.get_option(other));
  }
  for (const char* other : {"--pin", "--json"}) {
    command.get_option("--each")->excludes(command.get_option(other));
  }
  add_page_options(command, args.page.page);
  for (const char* option : {"--port", "--lan", "--web-root", "--no-open"}) {
    command.get_option(option)->needs(page);
  }
  command.add_option("--seconds", args.page.seconds, "Ends the page after this time [s]")
      ->check(between(0.001, 1e6))
      ->needs(page);
}

}  // namespace

void add_edit_command(CLI::App& app,
                      EditArguments& args,
                      std::function<Exit(Console&)>& chosen) {
  CLI::App* command = app.add_subcommand("edit",
                                         "Apply a recipe of operations to a motion or to "
                                         "labelled markers");
  auto* recipe = command->add_option(
      "RECIPE",
      args.recipe,
      "Recipe (.edit.toml); with --page: also a motion; with --new: a "
      "motion, or markers (.c3d, .trc)");
  command->add_option("-o,--out", args.out, "Folder of the results");
  command
      ->add_option("--format",
                   args.formats,
                   "Format of the results, may be repeated; default npz, bvh, glb and "
                   "vrma as the body allows; c3d and trc for labelled markers")
      ->allow_extra_args(false);
  command->add_option("--until", args.until, "Number of operations to apply")
      ->check(whole_between(0, 10000));
  command->add_option("--each",
                      args.each,
                      "Applies the recipe to all motions of a pattern, such as "
                      "'takes/*/motion.npz'");
  command->add_option("--new",
                      args.new_recipe,
                      "Makes a recipe without operations for the motion or the "
                      "markers");
  command->add_flag("--check", args.check, "Measures the result and writes nothing");
  command->add_flag("--pin",
                    args.pin,
                    "Records the SHA-256 of the sources in the recipe (comments of the "
                    "file are lost)");
  command->add_flag("--accept-new-source",
                    args.accept_new_source,
                    "Accepts sources that changed since they were recorded");
  command->add_flag("--json", args.json, "Prints edit.json on standard output");
  relate_edit_options(*command, args);
  CLI::App* diff = command->add_subcommand(
      "diff", "Compare two recipes: their operations and their results");
  diff->add_option("A", args.diff_first, "Recipe")->required();
  diff->add_option("B", args.diff_second, "Recipe")->required();
  diff->callback([&] {
    chosen = [&args](Console& console) { return run_edit_diff(args, console); };
  });
  command->callback([&args, &chosen, recipe, diff] {
    if (diff->parsed()) return;
    if (recipe->count() == 0) {
      throw RejectedArguments(
          "RECIPE is missing",
          "give a recipe (.edit.toml); marey edit --help describes the arguments");
    }
    chosen = [&args](Console& console) { return run_edit(args, console); };
  });
}

}  // namespace marey::app
