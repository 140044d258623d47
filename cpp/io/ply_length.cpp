#include "ply_length.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "../error.hpp"

namespace realcam::io {
namespace {

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::uint64_t least_bytes = 0;  // of one: what has no fixed length counts as a triangle
};

std::uint64_t size_of(const std::string& type) {
    static const std::map<std::string, std::uint64_t> sizes = {
        {"char", 1},   {"uchar", 1}, {"int8", 1},    {"uint8", 1},  {"short", 2},   {"ushort", 2}, {"int16", 2}, {"uint16", 2},
        {"int", 4},    {"uint", 4},  {"int32", 4},   {"uint32", 4}, {"float", 4},   {"float32", 4}, {"double", 8}, {"float64", 8}};
    const auto found = sizes.find(type);
    return found == sizes.end() ? 0 : found->second;
}

// Reads up to and including end_header.
std::vector<Element> read_header(std::ifstream& file, bool& is_ascii) {
    std::vector<Element> elements;
    std::string line, word, type, count_type;
    while (std::getline(file, line)) {
        std::istringstream words(line);
        words >> word;
        if (word == "end_header") return elements;
        if (word == "format") {
            words >> type;
            is_ascii = type == "ascii";
        } else if (word == "element") {
            Element element;
            words >> element.name >> element.count;
            elements.push_back(element);
        } else if (word == "property" && !elements.empty()) {
            words >> type;
            std::uint64_t bytes = size_of(type);
            if (type == "list") {
                words >> count_type >> type;
                bytes = size_of(count_type) + (elements.back().name == "face" ? 3 * size_of(type) : 0);
            }
            elements.back().least_bytes += bytes;
        }
    }
    return {};
}

}  // namespace

void check_ply_is_whole(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    bool is_ascii = false;
    const std::vector<Element> elements = read_header(file, is_ascii);
    if (elements.empty()) return;

    if (!is_ascii) {
        const auto start = static_cast<std::uint64_t>(file.tellg());
        std::uint64_t wanted = start;
        // Only up to the faces: what follows has no least length.
        for (const Element& element : elements) {
            wanted += element.count * element.least_bytes;
            if (element.name == "face") break;
        }
        const std::uint64_t size = std::filesystem::file_size(path);
        if (size < wanted) {
            throw SceneFileError(path + ": is cut short: its header promises at least " + std::to_string(wanted) +
                                 " bytes, and it has " + std::to_string(size));
        }
        return;
    }
    std::string line;
    for (const Element& element : elements) {
        for (std::uint64_t i = 0; i < element.count; ++i) {
            do {
                if (!std::getline(file, line)) {
                    throw SceneFileError(path + ": is cut short: its header promises " + std::to_string(element.count) +
                                         " of \"" + element.name + "\", and it has " + std::to_string(i));
                }
            } while (line.find_first_not_of(" \t\r") == std::string::npos);
        }
    }
}

}  // namespace realcam::io
