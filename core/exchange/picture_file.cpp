#include "exchange/picture_file.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include "base/error.h"

namespace glisson::exchange {

RgbPicture readPng(const std::filesystem::path& file) {
  const std::string which = "'" + file.filename().string() + "'";
  vtkNew<vtkPNGReader> reader;
  if (!std::filesystem::is_regular_file(file) || reader->CanReadFile(file.c_str()) == 0)
    throw BadInput(which + " is no PNG picture");
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  const int components = image->GetNumberOfScalarComponents();
  int size[3];
  image->GetDimensions(size);
  if (reader->GetErrorCode() != 0 || image->GetScalarType() != VTK_UNSIGNED_CHAR || components < 3 || size[0] < 1)
    throw BadInput(which + " is no 8-bit colour PNG");
  RgbPicture picture{size[0], size[1], {}};
  picture.rgb.reserve(3 * static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]));
  for (int y = size[1] - 1; y >= 0; --y) {  // VTK counts rows from the bottom
    const auto* row = static_cast<const std::uint8_t*>(image->GetScalarPointer(0, y, 0));
    for (int x = 0; x < size[0]; ++x)
      picture.rgb.insert(picture.rgb.end(), row + components * x, row + components * x + 3);
  }
  return picture;
}

}  // namespace glisson::exchange
