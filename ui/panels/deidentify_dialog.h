// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "panels/work_dialog.h"
#include "session/deidentify_folder.h"

class QCheckBox;
class QTextBrowser;

namespace glisson::panels {

/// Copies of a folder of DICOM files without what identifies the patient, and what was changed in them.
class DeidentifyDialog : public WorkDialog {
  Q_OBJECT
 public:
  explicit DeidentifyDialog(QWidget* parent = nullptr);

 signals:
  void openWanted(const QString& folder);  ///< what was written

 protected:
  void refresh() override;

 private:
  session::DeidentifyWish wish() const;
  void start();
  void tell(const session::DeidentifyReport& report);
  void refuse(const QString& reason);
  QLineEdit *in_, *out_, *key_;
  QCheckBox *dates_, *descriptors_, *characteristics_;
  QTextBrowser* told_;
  QPushButton *start_, *open_;
  QString written_;  ///< folder of the last success
};

}  // namespace glisson::panels
