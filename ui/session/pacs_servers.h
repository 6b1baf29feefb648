// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <filesystem>
#include <string>
#include <vector>

#include "pacs/node.h"
#include "pacs/retrieve.h"
#include "pacs/send.h"
#include "session/export_formats.h"

namespace glisson::session {

/// A DICOM server by the name that its user gave it.
struct PacsServer {
  QString name;
  pacs::Node node;
  bool move = false;      ///< fetch by C-MOVE to a receiver of our own
  int receivePort = 104;  ///< with move
};

/// The servers kept in the settings, as the user arranged them; never a query or anything of a patient.
std::vector<PacsServer> keptServers();
void keepServers(const std::vector<PacsServer>& servers);

/// A study, or a series of one, to be fetched.
struct FetchWish {
  std::string studyUid;
  std::string seriesUid;  ///< empty: the whole study
};

struct Fetched {
  std::size_t objects = 0, alreadyThere = 0;
  bool complete = true;  ///< all that the server said it has
  std::vector<pacs::Refusal> refused;
  std::filesystem::path folder;  ///< what to open: of the study, or of all where there are several
};

/// Fetches each study into a folder of its own below `folder`, named by a digest of its UID, so that no name of a
/// folder tells of the patient. Throws BadInput, pacs::NetworkError, Cancelled; what has arrived by then stays.
Fetched fetch(const PacsServer& server, const std::vector<FetchWish>& wishes, const std::filesystem::path& folder,
              const Progress& progress = {});

struct SendWish {
  std::vector<std::string> formats;          ///< DICOM formats of what is shown (export_formats.h)
  std::vector<std::filesystem::path> paths;  ///< files and folders beside them
};

struct SentAway {
  pacs::Sent sent;
  std::vector<pipeline::RefusedFormat> refused;  ///< formats that were not made
};

/// Makes the formats in a private folder and sends them with the paths. source: null where no formats are asked for.
/// Throws BadInput where there is nothing to send, pacs::NetworkError, Cancelled.
SentAway sendAway(const pacs::Node& node, const SendWish& wish, const ExportSource* source,
                  const Progress& progress = {});

}  // namespace glisson::session
