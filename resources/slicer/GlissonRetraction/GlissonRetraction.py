# SPDX-License-Identifier: GPL-3.0-or-later
"""Glisson in 3D Slicer: an outline drawn here, a retraction computed by glisson-cli, its results as nodes."""
import pathlib
import tempfile

import ctk
import qt
import slicer
from slicer.ScriptedLoadableModule import (ScriptedLoadableModule, ScriptedLoadableModuleLogic, ScriptedLoadableModuleTest,
                                           ScriptedLoadableModuleWidget)

from GlissonRetractionLib import command_line, nodes, results, scene


class GlissonRetraction(ScriptedLoadableModule):
    def __init__(self, parent):
        ScriptedLoadableModule.__init__(self, parent)
        parent.title = "Glisson: retraction of the liver"
        parent.categories = ["Glisson"]
        parent.contributors = ["The Glisson authors"]
        parent.helpText = ("Retracts a patient's liver with the stiffness of its elastogram and with the textbook's. "
                           "Research use only, not for clinical use.")


class GlissonRetractionWidget(ScriptedLoadableModuleWidget):
    def setup(self):
        ScriptedLoadableModuleWidget.setup(self)
        form = qt.QFormLayout()
        self.layout.addLayout(form)
        self.mri, self.mre, self.output = (self._folder() for _ in range(3))
        form.addRow("MRI (DICOM folder):", self.mri)
        form.addRow("MR elastography (DICOM folder):", self.mre)
        self.outline = slicer.qMRMLNodeComboBox()
        self.outline.nodeTypes = ["vtkMRMLSegmentationNode"]
        self.outline.addEnabled = self.outline.removeEnabled = False
        self.outline.setMRMLScene(slicer.mrmlScene)
        form.addRow("Outline of the liver:", self.outline)
        self.image = slicer.qMRMLNodeComboBox()
        self.image.nodeTypes = ["vtkMRMLScalarVolumeNode"]
        self.image.addEnabled = self.image.removeEnabled = False
        self.image.setMRMLScene(slicer.mrmlScene)
        form.addRow("Image it was drawn on:", self.image)
        self.uncertainty = qt.QCheckBox("say how sure the answer is (takes longer)")
        form.addRow(self.uncertainty)
        form.addRow("Results into:", self.output)
        self.button = qt.QPushButton("Retract")
        self.button.connect("clicked(bool)", self.onRetract)
        form.addRow(self.button)
        self.said = qt.QTextBrowser()
        self.layout.addWidget(self.said)

    @staticmethod
    def _folder():
        edit = ctk.ctkPathLineEdit()
        edit.filters = ctk.ctkPathLineEdit.Dirs
        return edit

    def onRetract(self):
        with slicer.util.tryWithErrorDisplay("The liver was not retracted.", waitCursor=True):
            rows = GlissonRetractionLogic().retract(
                self.mri.currentPath, self.mre.currentPath, self.outline.currentNode(), self.image.currentNode(),
                self.output.currentPath, self.uncertainty.checked, self._progress)
            self.said.setPlainText("\n".join(f"{what}: {value}" for what, value in rows))

    @staticmethod
    def _progress(percent, words):
        slicer.util.showStatusMessage(f"{percent} %  {words}")
        slicer.app.processEvents()


class GlissonRetractionLogic(ScriptedLoadableModuleLogic):
    def retract(self, mri, mre, segmentation, image, output="", uncertainty=False, progress=None):
        """Runs the retraction and loads its results; returns rows of (what, value)."""
        if segmentation is None or image is None:
            raise ValueError("choose the outline of the liver and the image that it was drawn on")
        folder = pathlib.Path(output or tempfile.mkdtemp(prefix="glisson-"))
        folder.mkdir(parents=True, exist_ok=True)
        roi = self.write_mask(segmentation, image, folder / "outline.nrrd")
        path = scene.write_scene(folder, scene.patient_scene(mri, mre, roi, uncertainty=uncertainty))
        record = command_line.run("run", path, "--output", folder / "run", progress=progress)
        command_line.run("export", path, "--to", "slicer", "--output", folder / "slicer", progress=progress)
        landmarks = folder / "run" / "vessels.csv"
        nodes.add_results(slicer, results.file_nodes(folder / "slicer"),
                          results.vessels(landmarks) if landmarks.is_file() else None)
        return results.figures(record)

    @staticmethod
    def write_mask(segmentation, image, file):
        """The visible segments together, on the image's voxels, as a label map."""
        labels = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLLabelMapVolumeNode")
        try:
            if not slicer.modules.segmentations.logic().ExportVisibleSegmentsToLabelmapNode(segmentation, labels, image):
                raise ValueError("the outline could not be written; is a segment visible?")
            # Several segments are one liver.
            voxels = slicer.util.arrayFromVolume(labels)
            slicer.util.updateVolumeFromArray(labels, (voxels > 0).astype("uint8"))
            if not slicer.util.saveNode(labels, str(file)):
                raise ValueError(f"'{file}' could not be written")
        finally:
            slicer.mrmlScene.RemoveNode(labels)
        return file


class GlissonRetractionTest(ScriptedLoadableModuleTest):
    def runTest(self):
        self.assertTrue(command_line.program())
