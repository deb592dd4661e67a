#pragma once
#include <filesystem>
#include <fstream>
#include <string>

#include "file.h"

/// A fresh folder that goes away with its object.
struct TemporaryFolder {
  voxref::ScratchFolder folder;
  std::filesystem::path path = folder.path();

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::ofstream(path / name, std::ios::binary) << content;
    return path / name;
  }
};
