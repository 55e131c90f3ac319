# cmake -DPARTS="name=file;..." -DOUTPUT=embedded.cpp -P MstslEmbed.cmake
#
# Writes files into a C++ source, each as a string_view mstsl::report::embedded::<name>.
set(text "#include \"embedded.hpp\"\n\nnamespace mstsl::report::embedded {\n")
foreach(part IN LISTS PARTS)
  string(REGEX MATCH "^([^=]+)=(.+)$" _ "${part}")
  set(name ${CMAKE_MATCH_1})
  file(READ "${CMAKE_MATCH_2}" hex HEX)
  string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${hex}")
  string(APPEND text "static constexpr char ${name}_bytes[] = {${bytes}};\n"
                     "const std::string_view ${name}{${name}_bytes, sizeof ${name}_bytes};\n")
endforeach()
file(WRITE "${OUTPUT}" "${text}}  // namespace mstsl::report::embedded\n")
