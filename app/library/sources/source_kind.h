// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace marey::app {

/// Kind of a session's folder, and the file that makes a folder a session.
inline constexpr const char* kSessionKind = "session";
inline constexpr const char* kSessionFile = "session.toml";
/// Kind of a recipe of `marey edit` (NAME.edit.toml).
inline constexpr const char* kRecipeKind = "recipe";

/// Files that the reader of labelled markers uses if they are in the folder of the
/// markers: the subject of an earlier `marey fit`, and the meaning of labels.
inline constexpr const char* kMarkerSubjectFile = "subject.toml";
inline constexpr const char* kMarkerMapFile = "markers.toml";

/// Returns the kind of a source by its name: its extension in lower case without the
/// point ("bvh"), kRecipeKind or kSessionKind; empty: no library reads it. Folders are
/// sessions if they contain kSessionFile. Does not read the file.
[[nodiscard]] std::string source_kind(const std::filesystem::path& path);

/// Returns the name of a source without folders and without the ending of its kind:
/// "walk" for "a/walk.bvh" and for the recipe "a/walk.edit.toml". The folder of a session
/// has no ending: "take.2" stays.
[[nodiscard]] std::string source_stem(const std::string& name, const std::string& kind);

/// Returns true for files that belong to a source next to them: skeletons of AMC, buffers
/// of glTF, bone maps, subjects, meanings of labels.
[[nodiscard]] bool is_companion_file(const std::filesystem::path& path);

/// Returns true if a word is a kind that source_kind() returns.
[[nodiscard]] bool is_source_kind(const std::string& word);

/// Returns the kinds of sources that a library reads, for help and messages.
[[nodiscard]] std::string source_kinds();

}  // namespace marey::app
