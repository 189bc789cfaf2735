# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# embed_file(<symbol> <variable> <file> ...): appends declarations of `symbol` and
# `symbol`_end to the variable, between which are the bytes of the files, one after the
# other. The assembler reads them: a compiler takes half a minute for a megabyte of numbers.
# The hash makes a compiler cache notice that they have changed.
function(embed_file symbol variable)
  set(parts "")
  foreach(file ${ARGN})
    if(NOT EXISTS ${file})
      message(FATAL_ERROR "${file}: is missing")
    endif()
    file(SHA256 ${file} hash)
    string(APPEND parts ".incbin \"${file}\"\n# ${hash}\n")
  endforeach()
  set(${variable} "${${variable}}
asm(R\"(.pushsection .rodata, \"a\", @progbits
${symbol}:
${parts}${symbol}_end:
.byte 0
.popsection)\");
extern \"C\" const char ${symbol}[];
extern \"C\" const char ${symbol}_end[];
" PARENT_SCOPE)
endfunction()
