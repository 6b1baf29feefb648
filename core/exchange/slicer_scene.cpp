// SPDX-License-Identifier: GPL-3.0-or-later
#include "exchange/slicer_scene.h"

#include "base/xml_text.h"
#include "exchange/text_file.h"

namespace glisson::exchange {
namespace {

/// Names of the node, of its storage and of its display as Slicer's scene format has them.
struct NodeKind {
  const char *element, *id, *storage, *storageId, *display, *displayId;
};

NodeKind kindOf(SlicerItem::Kind kind) {
  switch (kind) {
    case SlicerItem::Kind::Volume:
      return {"Volume",
              "vtkMRMLScalarVolumeNode",
              "VolumeArchetypeStorage",
              "vtkMRMLVolumeArchetypeStorageNode",
              "VolumeDisplay",
              "vtkMRMLScalarVolumeDisplayNode"};
    case SlicerItem::Kind::VectorVolume:
      return {"VectorVolume",           "vtkMRMLVectorVolumeNode",
              "VolumeArchetypeStorage", "vtkMRMLVolumeArchetypeStorageNode",
              "VectorVolumeDisplay",    "vtkMRMLVectorVolumeDisplayNode"};
    case SlicerItem::Kind::Segmentation:
      return {"Segmentation",        "vtkMRMLSegmentationNode",
              "SegmentationStorage", "vtkMRMLSegmentationStorageNode",
              "SegmentationDisplay", "vtkMRMLSegmentationDisplayNode"};
    case SlicerItem::Kind::Model:
      return {"Model",        "vtkMRMLModelNode",       "ModelStorage", "vtkMRMLModelStorageNode",
              "ModelDisplay", "vtkMRMLModelDisplayNode"};
    case SlicerItem::Kind::ClosedCurves: break;
  }
  return {"MarkupsClosedCurve", "vtkMRMLMarkupsClosedCurveNode", "MarkupsJsonStorage", "vtkMRMLMarkupsJsonStorageNode",
          "MarkupsDisplay",     "vtkMRMLMarkupsDisplayNode"};
}

}  // namespace

void writeSlicerScene(const std::filesystem::path& file, const std::vector<SlicerItem>& items) {
  std::string xml = "<MRML version=\"Slicer5.0.0\" userTags=\"\">\n";
  int n = 0;
  for (const SlicerItem& item : items) {
    const NodeKind k = kindOf(item.kind);
    const std::string index = std::to_string(++n), name = xmlEscaped(item.name);
    const std::string storage = k.storageId + index, display = k.displayId + index;
    xml += std::string("  <") + k.storage + " id=\"" + storage + "\" name=\"" + name +
           " storage\" hideFromEditors=\"true\" selectable=\"true\" selected=\"false\" fileName=\"" +
           xmlEscaped(item.file) + "\" useCompression=\"1\" readState=\"0\" writeState=\"4\"";
    if (item.kind == SlicerItem::Kind::Volume || item.kind == SlicerItem::Kind::VectorVolume)
      xml += " centerImage=\"0\" UseOrientationFromFile=\"1\"";
    if (item.kind == SlicerItem::Kind::Model) xml += " coordinateSystem=\"0\"";
    xml += std::string(" />\n  <") + k.display + " id=\"" + display + "\" name=\"" + name +
           " display\" hideFromEditors=\"true\" selectable=\"true\" selected=\"false\" color=\"" + shortest(item.red) +
           " " + shortest(item.green) + " " + shortest(item.blue) + "\" opacity=\"" + shortest(item.opacity) +
           "\" visibility=\"true\" />\n";
    xml += std::string("  <") + k.element + " id=\"" + k.id + index + "\" name=\"" + name +
           "\" hideFromEditors=\"false\" selectable=\"true\" selected=\"false\" references=\"display:" + display +
           ";storage:" + storage + ";\" />\n";
  }
  writeTextFile(file, xml + "</MRML>\n");
}

}  // namespace glisson::exchange
