// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Stubs for record_guest, a static program. FFmpeg's libraries refer to these functions
// in their lists of codecs, and the codec libraries are not available as static ones. The
// recorder uses none of these codecs. Other missing symbols stay unresolved
// (--unresolved-symbols).
extern "C" {
int aom_codec_version() {
  return 0;
}
void* aom_codec_av1_cx() {
  return nullptr;
}
long aom_codec_get_caps(void* /*codec*/) {
  return 0;
}
int vpx_codec_version() {
  return 0;
}
void* vpx_codec_vp9_cx() {
  return nullptr;
}
long vpx_codec_get_caps(void* /*codec*/) {
  return 0;
}
void* x265_api_get_199(int /*depth*/) {
  return nullptr;
}
int openmpt_is_extension_supported(const char* /*extension*/) {
  return 0;
}
unsigned long openmpt_probe_file_header_get_recommended_size() {
  return 2048;
}
int openmpt_probe_file_header_without_filesize() {
  return 0;
}
const char* gme_identify_header(const void* /*header*/) {
  return "";
}
}
