// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QString>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glisson::session {

class Session;

/// A run, as its record (run.json) tells of it.
struct RunRecord {
  std::string json;
  QString name;  ///< "Run at 14:32", or what the reader chose; never a folder's name
};

/// Reads the record of a run: its folder, or the folder of a case that keeps its last run. Throws BadInput.
std::string readRunRecord(const std::filesystem::path& folder);

/// A figure of both runs.
struct FigureBeside {
  const char* words;  ///< translated in the context "figures"
  const char* unit;
  int decimals = 2;
  std::optional<double> first, second;
  /// second less first
  std::optional<double> difference() const {
    return first && second ? std::optional<double>(*second - *first) : std::nullopt;
  }
};

/// A setting that both runs have otherwise; an empty text: not set.
struct SettingBeside {
  std::string key;  ///< path in scene.json: "material.poisson"
  std::string first, second;
};

struct RunsBeside {
  std::vector<FigureBeside> figures;  ///< those that either run has
  std::vector<SettingBeside> settings;
  std::vector<std::string> inputs;  ///< "mri", "mre", "roi": of other contents
  bool samePatient() const;         ///< the MRI is the same, or neither has one
};

/// Puts two records side by side. Throws BadInput where one is no record of a run.
RunsBeside beside(const RunRecord& first, const RunRecord& second);

/// The runs of this sitting, newest first, at most `kept`; those of the patient that is open. A run that was kept in
/// the case is among them.
class RunHistory : public QObject {
  Q_OBJECT
 public:
  static constexpr std::size_t kept = 20;
  explicit RunHistory(Session& session, QObject* parent = nullptr);
  const std::vector<RunRecord>& runs() const { return runs_; }

 signals:
  void changed();

 private:
  void add(const QString& name);
  Session& session_;
  std::vector<RunRecord> runs_;
  QString path_;
};

}  // namespace glisson::session
