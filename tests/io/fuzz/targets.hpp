#pragma once

#include "io/bytes.hpp"

/// What hostile bytes are fed to, one function a reader. Each has to come back, whatever the bytes; the
/// sanitizers see to the rest. libFuzzer drives them (fuzz_*.cpp, with clang), and so do the deterministic
/// mutations of mutation_test.cpp.
namespace mstsl::test {

/// Every message, in both encodings; what decodes must decode the same after encoding it again.
void try_ros_messages(io::ByteView bytes);
void try_mcap(io::ByteView bytes);
void try_bag(io::ByteView bytes);
/// As the text of a plain or gzipped log.
void try_carmen(io::ByteView bytes);
/// As a log of any format, all the way to events; these must be in time order between restarts, and finite.
void try_play(io::ByteView bytes);
/// As the metadata.yaml of a rosbag2 folder.
void try_rosbag2_metadata(io::ByteView bytes);
/// As a map image beside a good yaml, and as the yaml beside a good image.
void try_map_image(io::ByteView bytes);
void try_map_yaml(io::ByteView bytes);
void try_field_map(io::ByteView bytes);
/// As estimates, a TUM trajectory and a truth table.
void try_text_tables(io::ByteView bytes);

}  // namespace mstsl::test
