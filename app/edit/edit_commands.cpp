// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_commands.h"

#include <cstdio>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/edit/edit_batch.h"
#include "app/edit/edit_diff.h"
#include "app/edit/edit_inputs.h"
#include "app/edit/edit_json.h"
#include "app/edit/edit_outputs.h"
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

/// A recipe with its files and its result.
struct EditRun {
  EditRecipe recipe;
  EditFiles files;
  edit::Rendered rendered;
};

Result<EditRecipe> read_named_recipe(const fs::path& file) {
  if (!file.string().ends_with(".toml")) {
    return bad_input(file.string(),
                     "is not a recipe (.edit.toml)",
                     "edit it in a browser with --page, or make a recipe for it with "
                     "--new RECIPE.edit.toml");
  }
  auto recipe = recordings::read_edit_recipe(file);
  if (!recipe || !recipe->name.empty()) return recipe;
  recipe->name = file.stem().string();
  if (recipe->name.ends_with(".edit")) recipe->name.resize(recipe->name.size() - 5);
  return recipe;
}

Result<EditRun> render_recipe(const fs::path& file,
                              const EditArguments& args,
                              Console& console) {
  auto recipe = read_named_recipe(file);
  if (!recipe) return recipe.error();
  EditRun run;
  run.recipe = *std::move(recipe);
  auto files = read_edit_files(
      run.recipe, {file.parent_path(), file.string(), args.accept_new_source});
  if (!files) return files.error();
  run.files = *std::move(files);
  edit::RenderOptions options;
  options.recipe_file = file.string();
  if (args.until) options.until = static_cast<std::size_t>(*args.until);
  auto rendered = edit::render(
      run.recipe, std::move(run.files.inputs), options, console.stage("edit"));
  if (!rendered) return rendered.error();
  run.rendered = *std::move(rendered);
  return run;
}

/// Records the content of the sources in the recipe.
Status pin_sources(const fs::path& file, EditRun& run) {
  for (std::size_t i = 0; i < run.recipe.sources.size(); ++i) {
    run.recipe.sources[i].sha256 = run.files.sha256[i].substr(0, 64);
  }
  return recordings::write_edit_recipe(file, run.recipe);
}

Exit make_recipe(const EditArguments& args, Console& console) {
  if (const Status ok = check_out_file(args.new_recipe); !ok) {
    return console.fail(ok.error());
  }
  std::error_code failed;
  if (fs::exists(args.new_recipe, failed)) {
    return console.fail(bad_input(args.new_recipe.string(),
                                  "exists already",
                                  "give another name, or edit that recipe"));
  }
  EditRecipe recipe;
  recipe.name = args.recipe.stem().string();
  EditSource source;
  const fs::path folder = fs::absolute(args.new_recipe, failed).parent_path();
  source.path = fs::relative(fs::absolute(args.recipe, failed), folder, failed).string();
  if (source.path.empty()) source.path = fs::absolute(args.recipe, failed).string();
  recipe.sources.push_back(source);
  const auto files = read_edit_files(recipe, {folder, {}, false});
  if (!files) return console.fail(files.error());
  recipe.sources.front().sha256 = files->sha256.front().substr(0, 64);
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
      finding.where =
          "operation " + std::to_string(report.index + 1) + " (" + report.name + ")";
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

Result<std::vector<MotionFormat>> formats_of(const EditArguments& args) {
  std::vector<MotionFormat> out;
  for (const std::string& word : args.formats) {
    const auto format = motion_format(word);
    if (!format) {
      return bad_usage("--format",
                       in_quotes(word) + " is no format of a motion",
                       "choose one of " + motion_extensions());
    }
    out.push_back(*format);
  }
  return out;
}

Exit edit_many(const EditArguments& args, const EditOutput& output, Console& console) {
  const auto recipe = read_named_recipe(args.recipe);
  if (!recipe) return console.fail(recipe.error());
  const auto motions = files_of_pattern(args.each);
  if (!motions) return console.fail(motions.error());
  return run_edit_batch(*recipe, args.recipe, *motions, output, console);
}

void print_json(const nlohmann::ordered_json& json) {
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  std::printf("%s\n", json.dump(2, ' ', false, kReplace).c_str());
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

Exit edit_one_recipe(const EditArguments& args,
                     const EditOutput& output,
                     Console& console) {
  auto run = render_recipe(args.recipe, args, console);
  if (!run) return console.fail(run.error());
  const auto figures = measure_edit(run->recipe, run->files, run->rendered);
  const auto findings = findings_of(*run, figures);
  if (args.json) print_json(edit_json(run->recipe, run->files, run->rendered, figures));
  if (!args.check) {
    const auto written =
        write_edit(run->recipe, run->files, run->rendered, figures, output);
    if (!written) return console.fail(written.error());
  }
  print_warnings(console, findings);
  say_figures(figures, console);
  if (args.pin) {
    if (const Status ok = pin_sources(args.recipe, *run); !ok) {
      return console.fail(ok.error());
    }
  }
  return print_failures(console, findings);
}

}  // namespace

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
  auto formats = formats_of(args);
  if (!formats) return console.fail(formats.error());
  output.formats = *std::move(formats);
  if (!args.out.empty()) {
    if (const Status ok = check_out_folder(args.out); !ok)
      return console.fail(ok.error());
  }
  if (args.serves_page) return serve_recipe(args, output.formats, console);
  return args.each.empty() ? edit_one_recipe(args, output, console)
                           : edit_many(args, output, console);
}

Exit run_edit_diff(const EditArguments& args, Console& console) {
  const auto first = render_recipe(args.diff_first, args, console);
  if (!first) return console.fail(first.error());
  const auto second = render_recipe(args.diff_second, args, console);
  if (!second) return console.fail(second.error());
  const EditDifference difference =
      compare_edits(first->recipe, first->rendered, second->recipe, second->rendered);
  if (args.json) {
    nlohmann::ordered_json json{{"operations", difference.operations},
                                {"first_frames", difference.first_frames},
                                {"second_frames", difference.second_frames}};
    if (difference.motion) {
      json["largest_mm"] = difference.motion->largest_mm;
      json["joint"] = difference.motion->joint;
      json["frame"] = difference.motion->frame;
    }
    print_json(json);
    return Exit::kOk;
  }
  for (const std::string& line : difference.operations) std::printf("%s\n", line.c_str());
  std::printf("frames: %d and %d\n", difference.first_frames, difference.second_frames);
  if (difference.motion) {
    std::printf("largest difference: %.3f mm, %s, frame %d\n",
                difference.motion->largest_mm,
                difference.motion->joint.c_str(),
                difference.motion->frame);
  } else {
    std::printf("the results have different joints or several motions\n");
  }
  return Exit::kOk;
}

namespace {

/// Options of the page need --page. Options that write or measure exclude it.
void add_edit_page_options(CLI::App& command, EditArguments& args) {
  CLI::Option* page = command.add_flag(
      "--page",
      args.serves_page,
      "Edits in a browser; a motion gets the recipe NAME.edit.toml next to it");
  for (const char* other : {"--until", "--each", "--new", "--check", "--pin", "--json"}) {
    page->excludes(command.get_option(other));
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
  CLI::App* command =
      app.add_subcommand("edit", "Apply a recipe of operations to a motion");
  auto* recipe = command->add_option(
      "RECIPE", args.recipe, "Recipe (.edit.toml); with --new or --page: a motion");
  command->add_option("-o,--out", args.out, "Folder of the results");
  command
      ->add_option("--format",
                   args.formats,
                   "Format of the results, may be repeated; default npz, bvh, glb and "
                   "vrma as the body allows")
      ->allow_extra_args(false);
  command->add_option("--until", args.until, "Number of operations to apply")
      ->check(whole_between(0, 10000));
  command->add_option("--each",
                      args.each,
                      "Applies the recipe to all motions of a pattern, such as "
                      "'takes/*/motion.npz'");
  command->add_option(
      "--new", args.new_recipe, "Makes a recipe for the motion without operations");
  command->add_flag("--check", args.check, "Measures the result and writes nothing");
  command->add_flag("--pin",
                    args.pin,
                    "Records the SHA-256 of the sources in the recipe (comments of the "
                    "file are lost)");
  command->add_flag("--accept-new-source",
                    args.accept_new_source,
                    "Accepts sources that changed since they were recorded");
  command->add_flag("--json", args.json, "Prints edit.json on standard output");
  add_edit_page_options(*command, args);
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
