<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de">
    <context>
        <name>glisson::panels::ComparePage</name>
        <message>
            <source>Film the retraction…</source>
            <translation>Retraktion filmen…</translation>
        </message>
        <message>
            <source>Film the retraction</source>
            <translation>Retraktion filmen</translation>
        </message>
        <message>
            <source>Videos (*.webm *.mp4)</source>
            <translation>Videos (*.webm *.mp4)</translation>
        </message>
        <message>
            <source>The 3-D view from rest to the end, as WebM or MP4, with this camera and these colours</source>
            <translation>Die 3-D-Ansicht von der Ruhe bis zum Ende, als WebM oder MP4, mit dieser Kamera und diesen Farben</translation>
        </message>
        <message>
            <source>± %1 by the size of the cells</source>
            <translation>± %1 durch die Zellgröße</translation>
        </message>
        <message>
            <source>What both answers share cancels: the difference shown errs by %1 mm on average.</source>
            <translation>Was beide Antworten gemeinsam haben, hebt sich auf: Der gezeigte Unterschied irrt im Mittel um %1 mm.</translation>
        </message>
        <message>
            <source>That is more than half of the mean difference: use smaller cells before concluding.</source>
            <translation>Das ist mehr als die Hälfte des mittleren Unterschieds: Vor einem Schluss kleinere Zellen nehmen.</translation>
        </message>
        <message>
            <source>Drawing the slice…</source>
            <translation>Die Schicht wird gezeichnet…</translation>
        </message>
        <message>
            <source>Displacement arrows</source>
            <translation>Verschiebungspfeile</translation>
        </message>
        <message>
            <source>From rest to where either answer puts a place, true to scale, in the slice and in 3-D; at most %1 places</source>
            <translation>Von der Ruhe dorthin, wohin jede der beiden Antworten eine Stelle legt, maßstäblich, in der Schicht und in 3-D; höchstens %1 Stellen</translation>
        </message>
        <message>
            <source>Magnify the difference</source>
            <translation>Unterschied vergrößern</translation>
        </message>
        <message>
            <source>Beside the slice: where both answers differ most in it, or the vessel that was chosen</source>
            <translation>Neben der Schicht: wo sich beide Antworten darin am meisten unterscheiden, oder das gewählte Gefäß</translation>
        </message>
        <message>
            <source>Run the retraction to compare MRE with the atlas.</source>
            <translation>Retraktion rechnen, um MRE und Atlas zu vergleichen.</translation>
        </message>
        <message>
            <source>Not run yet.</source>
            <translation>Noch nicht gerechnet.</translation>
        </message>
        <message>
            <source>The box plot of the differences appears here.</source>
            <translation>Hier erscheint der Boxplot der Unterschiede.</translation>
        </message>
        <message>
            <source>MRE against atlas</source>
            <translation>MRE gegen Atlas</translation>
        </message>
        <message>
            <source>Difference at the retractor</source>
            <translation>Unterschied am Retraktor</translation>
        </message>
        <message>
            <source>Over the whole liver</source>
            <translation>In der ganzen Leber</translation>
        </message>
        <message>
            <source>Hepatic vessels</source>
            <translation>Lebergefäße</translation>
        </message>
        <message>
            <source>How far to trust it</source>
            <translation>Wie weit es gilt</translation>
        </message>
        <message>
            <source>Display</source>
            <translation>Anzeige</translation>
        </message>
        <message>
            <source>Red / blue</source>
            <translation>Rot / Blau</translation>
        </message>
        <message>
            <source>Orange / blue (colour-blind)</source>
            <translation>Orange / Blau (farbenblind)</translation>
        </message>
        <message>
            <source>Colours</source>
            <translation>Farben</translation>
        </message>
        <message>
            <source>Oblique</source>
            <translation>Schräg</translation>
        </message>
        <message>
            <source>From the front</source>
            <translation>Von vorn</translation>
        </message>
        <message>
            <source>From below</source>
            <translation>Von unten</translation>
        </message>
        <message>
            <source>Camera</source>
            <translation>Blick</translation>
        </message>
        <message>
            <source>Overlay</source>
            <translation>Überlagerung</translation>
        </message>
        <message>
            <source>Difference in mm</source>
            <translation>Unterschied in mm</translation>
        </message>
        <message>
            <source>Slice</source>
            <translation>Schicht</translation>
        </message>
        <message>
            <source>3-D</source>
            <translation>3-D</translation>
        </message>
        <message>
            <source>Box plot</source>
            <translation>Boxplot</translation>
        </message>
        <message>
            <source>Beside it</source>
            <translation>Daneben</translation>
        </message>
        <message>
            <source>slice %1 / %2</source>
            <translation>Schicht %1 / %2</translation>
        </message>
        <message>
            <source>Export pictures and report…</source>
            <translation>Bilder und Bericht exportieren …</translation>
        </message>
        <message>
            <source>Slices, difference map, 3-D and box plot in these colours, report and record of the run</source>
            <translation>Schichten, Differenzkarte, 3-D und Boxplot in diesen Farben, Bericht und Protokoll des Laufs</translation>
        </message>
        <message>
            <source>mean %1, 95th percentile %2, largest %3
%4</source>
            <translation>Mittel %1, 95. Perzentil %2, größter %3
%4</translation>
        </message>
        <message>
            <source>At the retractor it cannot be told from the 5 mm that matter clinically: use smaller cells.</source>
            <translation>Am Retraktor nicht von den 5 mm zu unterscheiden, die klinisch zählen: kleinere Zellen nehmen.</translation>
        </message>
        <message>
            <source>At the retractor not below the 5 mm that matter clinically.</source>
            <translation>Am Retraktor nicht unter den 5 mm, die klinisch zählen.</translation>
        </message>
        <message>
            <source>At the retractor below the 5 mm that matter clinically.</source>
            <translation>Am Retraktor unter den 5 mm, die klinisch zählen.</translation>
        </message>
        <message>
            <source>No vessel landmarks were found.</source>
            <translation>Keine Gefäßpunkte gefunden.</translation>
        </message>
        <message>
            <source>Places on vessels where MRE and atlas lie 5 mm or more apart</source>
            <translation>Gefäßstellen, an denen MRE und Atlas 5 mm oder mehr auseinanderliegen</translation>
        </message>
        <message>
            <source>Apart</source>
            <translation>Abstand</translation>
        </message>
        <message>
            <source>L, P, S (mm)</source>
            <translation>L, P, S (mm)</translation>
        </message>
        <message>
            <source>Choose a place: the slice shows it, magnified</source>
            <translation>Stelle wählen: die Schicht zeigt sie vergrößert</translation>
        </message>
        <message>
            <source>%1 mm</source>
            <translation>%1 mm</translation>
        </message>
        <message>
            <source>Something has changed since this run: run again.</source>
            <translation>Seit diesem Lauf hat sich etwas geändert: neu rechnen.</translation>
        </message>
        <message>
            <source>No warning: strains and rotations are within linear theory.</source>
            <translation>Keine Warnung: Dehnungen und Drehungen liegen im Bereich der linearen Theorie.</translation>
        </message>
        <message>
            <source>The cells of %1 mm may shift a place by %2 mm on average, and by no more than %3 mm in 95 % of the liver (estimated from cells twice as large).</source>
            <translation>Die Zellen von %1 mm können eine Stelle im Mittel um %2 mm verschieben, in 95 % der Leber um höchstens %3 mm (geschätzt aus doppelt so großen Zellen).</translation>
        </message>
        <message>
            <source>How much the size of the cells matters is not known: %1</source>
            <translation>Wie viel die Größe der Zellen ausmacht, ist nicht bekannt: %1</translation>
        </message>
        <message>
            <source>Folder for pictures and report</source>
            <translation>Ordner für Bilder und Bericht</translation>
        </message>
        <message>
            <source>The vessels in 3-D appear here.</source>
            <translation>Hier erscheinen die Gefäße in 3-D.</translation>
        </message>
        <message>
            <source>Error against run time</source>
            <translation>Fehler gegen Rechenzeit</translation>
        </message>
        <message>
            <source>%1 landmarks: mean %2, 95th percentile %3, largest %4; %5 of them at 5 mm or more</source>
            <translation>%1 Landmarken: im Mittel %2, 95. Perzentil %3, größte %4; %5 davon bei 5 mm oder mehr</translation>
        </message>
        <message>
            <source>Contact</source>
            <translation>Kontakt</translation>
        </message>
        <message>
            <source>Both answers</source>
            <translation>Beide Antworten</translation>
        </message>
        <message>
            <source>Contact pressure, MRE</source>
            <translation>Kontaktdruck, MRE</translation>
        </message>
        <message>
            <source>Contact pressure, atlas</source>
            <translation>Kontaktdruck, Atlas</translation>
        </message>
        <message>
            <source>3-D shows</source>
            <translation>3-D zeigt</translation>
        </message>
        <message>
            <source>Force against travel</source>
            <translation>Kraft über dem Weg</translation>
        </message>
        <message>
            <source>Liver and vessels of both answers, or the contact pressure on one</source>
            <translation>Leber und Gefäße beider Antworten, oder der Kontaktdruck auf einer</translation>
        </message>
        <message>
            <source>Contact pressure is known after a run with a rigid bar.</source>
            <translation>Der Kontaktdruck ist nach einer Rechnung mit starrem Bügel bekannt.</translation>
        </message>
        <message>
            <source>After a run with a rigid bar: its force against its travel.</source>
            <translation>Nach einer Rechnung mit starrem Bügel: seine Kraft über seinem Weg.</translation>
        </message>
        <message>
            <source>No difference is given: see Contact.</source>
            <translation>Kein Unterschied wird angegeben: siehe Kontakt.</translation>
        </message>
        <message>
            <source>No warning: the large deformation converged.</source>
            <translation>Keine Warnung: Die große Verformung ist konvergiert.</translation>
        </message>
        <message>
            <source>How sure the vessels are</source>
            <translation>Wie sicher die Gefäße sind</translation>
        </message>
        <message>
            <source>Chance of 5 mm</source>
            <translation>Wahrscheinlichkeit von 5 mm</translation>
        </message>
        <message>
            <source>What it depends on</source>
            <translation>Wovon es abhängt</translation>
        </message>
        <message>
            <source>After a run that says how sure it is (Model): what the difference at the retractor depends on.</source>
            <translation>Nach einer Rechnung, die sagt, wie sicher sie ist (Modell): wovon der Unterschied am Retraktor abhängt.</translation>
        </message>
        <message>
            <source>95 %: %1; chance of 5 mm or more: %2</source>
            <translation>95 %: %1; Wahrscheinlichkeit von 5 mm oder mehr: %2</translation>
        </message>
        <message>
            <source>
95 %: mean %1, largest %2; %3 to %4 % at 5 mm or more</source>
            <translation>
95 %: Mittel %1, größter %2; %3 bis %4 % mit 5 mm oder mehr</translation>
        </message>
        <message>
            <source>%1 to %2 by what is uncertain of the patient (95 %)</source>
            <translation>%1 bis %2 durch das, was am Patienten unsicher ist (95 %)</translation>
        </message>
        <message>
            <source>Run again</source>
            <translation>Neu rechnen</translation>
        </message>
        <message>
            <source>With what is outlined and set now</source>
            <translation>Mit dem, was jetzt umrissen und eingestellt ist</translation>
        </message>
        <message>
            <source>Cannot be told from the 5 mm that matter clinically.</source>
            <translation>Von den klinisch bedeutsamen 5 mm nicht zu unterscheiden.</translation>
        </message>
        <message>
            <source>5 mm or more: it matters clinically.</source>
            <translation>5 mm oder mehr: klinisch bedeutsam.</translation>
        </message>
        <message>
            <source>Below the 5 mm that matter clinically.</source>
            <translation>Unter den klinisch bedeutsamen 5 mm.</translation>
        </message>
        <message>
            <source>No difference is given: one of the two runs is no answer.</source>
            <translation>Kein Unterschied wird angegeben: Eine der beiden Rechnungen ist keine Antwort.</translation>
        </message>
        <message>
            <source>Nothing was compared.</source>
            <translation>Es wurde nichts verglichen.</translation>
        </message>
        <message>
            <source>mean %1, 95th percentile %2, largest %3</source>
            <translation>Mittel %1, 95. Perzentil %2, größter %3</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::ImageLayers</name>
        <message>
            <source>Stiffness</source>
            <translation>Steifigkeit</translation>
        </message>
        <message>
            <source>Magnitude</source>
            <translation>Magnitude</translation>
        </message>
        <message>
            <source>Wave</source>
            <translation>Welle</translation>
        </message>
        <message>
            <source>Confidence</source>
            <translation>Konfidenz</translation>
        </message>
        <message>
            <source>Show the %1 image</source>
            <translation>Zeigt das Bild „%1“</translation>
        </message>
        <message>
            <source>Play the wave (V)</source>
            <translation>Welle abspielen (V)</translation>
        </message>
        <message>
            <source>MRE magnitude</source>
            <translation>MRE-Magnitude</translation>
        </message>
        <message>
            <source>MRE stiffness (µ)</source>
            <translation>MRE-Steifigkeit (µ)</translation>
        </message>
        <message>
            <source>MRE confidence</source>
            <translation>MRE-Konfidenz</translation>
        </message>
        <message>
            <source>MRE wave</source>
            <translation>MRE-Welle</translation>
        </message>
        <message>
            <source>Time step of the wave</source>
            <translation>Zeitschritt der Welle</translation>
        </message>
        <message>
            <source>one time step</source>
            <translation>ein Zeitschritt</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::KeySheet</name>
        <message>
            <source>3-D views and pictures</source>
            <translation>3-D-Ansichten und Bilder</translation>
        </message>
        <message>
            <source>3-D</source>
            <translation>3-D</translation>
        </message>
        <message>
            <source>Keys and mouse</source>
            <translation>Tasten und Maus</translation>
        </message>
        <message>
            <source>What</source>
            <translation>Was</translation>
        </message>
        <message>
            <source>Key</source>
            <translation>Taste</translation>
        </message>
        <message>
            <source>Group</source>
            <translation>Gruppe</translation>
        </message>
        <message>
            <source>Keys</source>
            <translation>Tasten</translation>
        </message>
        <message>
            <source>Mouse</source>
            <translation>Maus</translation>
        </message>
        <message>
            <source>Idle</source>
            <translation>Ruhe</translation>
        </message>
        <message>
            <source>Drawing</source>
            <translation>Zeichnen</translation>
        </message>
        <message>
            <source>Editing, accepted</source>
            <translation>Bearbeiten, angenommen</translation>
        </message>
        <message>
            <source>Double-click a key to change it. Keys work while the mouse is over an image.</source>
            <translation>Doppelklick auf eine Taste ändert sie. Tasten wirken, solange die Maus über einem Bild steht.</translation>
        </message>
        <message>
            <source>As shipped</source>
            <translation>Wie ausgeliefert</translation>
        </message>
        <message>
            <source>Press the new key:</source>
            <translation>Neue Taste drücken:</translation>
        </message>
        <message>
            <source>This key already means: %1</source>
            <translation>Diese Taste bedeutet schon: %1</translation>
        </message>
        <message>
            <source>Steps and menus</source>
            <translation>Schritte und Menüs</translation>
        </message>
        <message>
            <source>Step %1</source>
            <translation>Schritt %1</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::LiveBar</name>
        <message>
            <source>Move live</source>
            <translation>Live bewegen</translation>
        </message>
        <message>
            <source>Drag the retractor in the picture, or use the sliders: both livers follow</source>
            <translation>Den Retraktor im Bild ziehen oder die Regler nehmen: beide Lebern folgen</translation>
        </message>
        <message>
            <source>right – left</source>
            <translation>rechts – links</translation>
        </message>
        <message>
            <source>front – back</source>
            <translation>vorn – hinten</translation>
        </message>
        <message>
            <source>down – up</source>
            <translation>unten – oben</translation>
        </message>
        <message>
            <source>Tool, %1, mm</source>
            <translation>Werkzeug, %1, mm</translation>
        </message>
        <message>
            <source>As run</source>
            <translation>Wie gerechnet</translation>
        </message>
        <message>
            <source>Back to the force or the travel of the run</source>
            <translation>Zurück zur Kraft oder zum Weg des Laufs</translation>
        </message>
        <message>
            <source>Run the retraction; then the retractor can be moved by hand.</source>
            <translation>Retraktion rechnen; dann lässt sich der Retraktor von Hand bewegen.</translation>
        </message>
        <message>
            <source>Preparing to move live: %1 %</source>
            <translation>Live-Bewegung wird vorbereitet: %1 %</translation>
        </message>
        <message>
            <source>The retractor cannot be moved live. %1</source>
            <translation>Der Retraktor lässt sich nicht live bewegen. %1</translation>
        </message>
        <message>
            <source>Ready: "Move live" puts the retractor into your hand.</source>
            <translation>Bereit: „Live bewegen“ gibt den Retraktor in die Hand.</translation>
        </message>
        <message>
            <source>%1 mm</source>
            <translation>%1 mm</translation>
        </message>
        <message>
            <source>What both livers share</source>
            <translation>Was beide Lebern gemeinsam haben</translation>
        </message>
        <message>
            <source>equal force</source>
            <translation>gleiche Kraft</translation>
        </message>
        <message>
            <source>equal travel</source>
            <translation>gleicher Weg</translation>
        </message>
        <message>
            <source>Equal force: the liver with textbook stiffness is pulled as hard as the measured one, as in the run. Equal travel: the tool goes as far in both</source>
            <translation>Gleiche Kraft: an der Leber mit Lehrbuchsteifigkeit wird so stark gezogen wie an der gemessenen, wie im Lauf. Gleicher Weg: das Werkzeug geht in beiden gleich weit</translation>
        </message>
        <message>
            <source>Tool %1 mm from rest with %2 N (the run: %3 N)</source>
            <translation>Werkzeug %1 mm aus der Ruhe mit %2 N (der Lauf: %3 N)</translation>
        </message>
        <message>
            <source>Tool %1 mm from rest with %2 N (the run: %3 mm)</source>
            <translation>Werkzeug %1 mm aus der Ruhe mit %2 N (der Lauf: %3 mm)</translation>
        </message>
        <message>
            <source>; with atlas stiffness it goes %1 mm, %2 mm from there</source>
            <translation>; mit Lehrbuchsteifigkeit geht es %1 mm weit, %2 mm von dort entfernt</translation>
        </message>
        <message>
            <source>; with atlas stiffness that takes %1 N</source>
            <translation>; mit Lehrbuchsteifigkeit braucht das %1 N</translation>
        </message>
        <message>
            <source>Simulation %1 ms a frame (%2 frames/s possible)</source>
            <translation>Simulation %1 ms je Bild (%2 Bilder/s möglich)</translation>
        </message>
        <message>
            <source>; on screen %1 pictures/s</source>
            <translation>; am Schirm %1 Bilder/s</translation>
        </message>
        <message>
            <source>; at rest, on %1 degrees of freedom</source>
            <translation>; in Ruhe, auf %1 Freiheitsgraden</translation>
        </message>
        <message>
            <source>; up to %1 mm from rest, on %2 degrees of freedom</source>
            <translation>; bis zu %1 mm von der Ruhe entfernt, auf %2 Freiheitsgraden</translation>
        </message>
        <message>
            <source>The bar slips: the liver does not bear this force here.</source>
            <translation>Der Bügel rutscht ab: die Leber trägt diese Kraft hier nicht.</translation>
        </message>
        <message>
            <source>With atlas stiffness the bar slips: that liver does not bear this force here.</source>
            <translation>Mit Lehrbuchsteifigkeit rutscht der Bügel ab: jene Leber trägt diese Kraft hier nicht.</translation>
        </message>
        <message>
            <source>The bar cuts into the liver: what is shown is no answer.</source>
            <translation>Der Bügel schneidet in die Leber: das Gezeigte ist keine Lösung.</translation>
        </message>
        <message>
            <source>With atlas stiffness the bar cuts into the liver: what is shown is no answer.</source>
            <translation>Mit Lehrbuchsteifigkeit schneidet der Bügel in die Leber: das Gezeigte ist keine Lösung.</translation>
        </message>
        <message>
            <source>; vessels: mean %1, largest %2 mm, %3 of %4 landmarks at 5 mm or more</source>
            <translation>; Gefäße: Mittel %1, größter %2 mm, %3 von %4 Punkten mit 5 mm oder mehr</translation>
        </message>
        <message>
            <source>Linear theory, far beyond the force of the run: shapes are not to be trusted.</source>
            <translation>Lineare Theorie, weit über der Kraft des Laufs: den Formen ist nicht zu trauen.</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::LoadPage</name>
        <message>
            <source>Open files…</source>
            <translation>Dateien öffnen…</translation>
        </message>
        <message>
            <source>Volumes, masks, maps, an archive or a case (Ctrl+Shift+O)</source>
            <translation>Volumen, Masken, Karten, ein Archiv oder einen Fall (Strg+Umschalt+O)</translation>
        </message>
        <message>
            <source>%1 series, %2 files left out. Tick the series to be used; correct a role where it is wrong.</source>
            <translation>%1 Serien, %2 Dateien ausgelassen. Die Serie anhaken, die verwendet werden soll; eine falsche Rolle berichtigen.</translation>
        </message>
        <message>
            <source>A DICOM folder with an abdominal MRI and an MR elastogram, or NIfTI, NRRD and MetaImage volumes, masks and stiffness maps. Drop them here together, or start with a synthetic patient to look around.</source>
            <translation>Ein DICOM-Ordner mit einer Abdomen-MRT und einem MR-Elastogramm, oder Volumen, Masken und Steifigkeitskarten als NIfTI, NRRD oder MetaImage. Zusammen hier ablegen, oder mit einem synthetischen Patienten beginnen, um sich umzusehen.</translation>
        </message>
        <message>
            <source>Outlines and masks beside the images</source>
            <translation>Konturen und Masken neben den Bildern</translation>
        </message>
        <message>
            <source>“%1” was not opened: %2</source>
            <translation>„%1“ wurde nicht geöffnet: %2</translation>
        </message>
        <message>
            <source>What was open before is still open.</source>
            <translation>Was vorher offen war, ist noch offen.</translation>
        </message>
        <message>
            <source>Open a patient</source>
            <translation>Patienten öffnen</translation>
        </message>
        <message>
            <source>A DICOM folder with an abdominal MRI and an MR elastogram. Drop it here, or start with a synthetic patient to look around.</source>
            <translation>Ein DICOM-Ordner mit Abdomen-MRT und MR-Elastogramm. Hier ablegen, oder zum Umsehen mit einem synthetischen Patienten beginnen.</translation>
        </message>
        <message>
            <source>Open DICOM folder…</source>
            <translation>DICOM-Ordner öffnen…</translation>
        </message>
        <message>
            <source>Open a folder (Ctrl+O)</source>
            <translation>Ordner öffnen (Strg+O)</translation>
        </message>
        <message>
            <source>Synthetic patient</source>
            <translation>Synthetischer Patient</translation>
        </message>
        <message>
            <source>Makes a synthetic patient as DICOM and opens it (Ctrl+Shift+N)</source>
            <translation>Erzeugt einen synthetischen Patienten als DICOM und öffnet ihn (Strg+Umschalt+N)</translation>
        </message>
        <message>
            <source>Recent</source>
            <translation>Zuletzt</translation>
        </message>
        <message>
            <source>Series</source>
            <translation>Serien</translation>
        </message>
        <message>
            <source>Open another…</source>
            <translation>Anderen öffnen…</translation>
        </message>
        <message>
            <source>Open another folder (Ctrl+O)</source>
            <translation>Anderen Ordner öffnen (Strg+O)</translation>
        </message>
        <message>
            <source>No.</source>
            <translation>Nr.</translation>
        </message>
        <message>
            <source>Description</source>
            <translation>Beschreibung</translation>
        </message>
        <message>
            <source>Role</source>
            <translation>Rolle</translation>
        </message>
        <message>
            <source>Why</source>
            <translation>Warum</translation>
        </message>
        <message>
            <source>Voxels</source>
            <translation>Voxel</translation>
        </message>
        <message>
            <source>Spacing</source>
            <translation>Abstand</translation>
        </message>
        <message>
            <source>Warnings</source>
            <translation>Warnungen</translation>
        </message>
        <message>
            <source>Files left out</source>
            <translation>Ausgelassene Dateien</translation>
        </message>
        <message>
            <source>File</source>
            <translation>Datei</translation>
        </message>
        <message>
            <source>Reason</source>
            <translation>Grund</translation>
        </message>
        <message>
            <source>%1 series, %2 files left out. ✓: in use. Correct a role where the guess is wrong.</source>
            <translation>%1 Serien, %2 Dateien ausgelassen. ✓: in Gebrauch. Eine falsch geratene Rolle lässt sich ändern.</translation>
        </message>
        <message>
            <source>Answer…</source>
            <translation>Antworten…</translation>
        </message>
        <message>
            <source>Asks again whether, and as what, the elastogram is used</source>
            <translation>Fragt noch einmal, ob und als was das Elastogramm verwendet wird</translation>
        </message>
        <message>
            <source>Not opened: %1</source>
            <translation>Nicht geöffnet: %1</translation>
        </message>
        <message>
            <source>%1 The elastogram is left out until this is answered.</source>
            <translation>%1 Das Elastogramm bleibt weg, bis das beantwortet ist.</translation>
        </message>
        <message>
            <source>Goes on with the series in use</source>
            <translation>Weiter mit den Serien in Gebrauch</translation>
        </message>
        <message>
            <source>Outline the liver</source>
            <translation>Leber umfahren</translation>
        </message>
        <message>
            <source>In use: the MRI that is drawn on</source>
            <translation>In Gebrauch: das MRT, auf dem gezeichnet wird</translation>
        </message>
        <message>
            <source>In use: the elastogram that is measured</source>
            <translation>In Gebrauch: das Elastogramm, das gemessen wird</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::MainWindow</name>
        <message>
            <source>&amp;Mouse</source>
            <translation>&amp;Maus</translation>
        </message>
        <message>
            <source>&amp;Three planes</source>
            <translation>&amp;Drei Ebenen</translation>
        </message>
        <message>
            <source>One view &amp;alone</source>
            <translation>Eine Ansicht &amp;allein</translation>
        </message>
        <message>
            <source>&amp;Manual</source>
            <translation>&amp;Handbuch</translation>
        </message>
        <message>
            <source>Manual</source>
            <translation>Handbuch</translation>
        </message>
        <message>
            <source>Right drag &amp;zooms</source>
            <translation>Ziehen mit rechts &amp;zoomt</translation>
        </message>
        <message>
            <source>Right drag changes &amp;window and level</source>
            <translation>Ziehen mit rechts ändert &amp;Fenster und Lage</translation>
        </message>
        <message>
            <source>The manual is not installed beside this program. It is in the folder resources/manual of the sources; packaging/manual makes HTML of it.</source>
            <translation>Das Handbuch ist nicht neben diesem Programm installiert. Es liegt im Ordner resources/manual der Quellen; packaging/manual macht HTML daraus.</translation>
        </message>
        <message>
            <source>Open case, volumes or archive</source>
            <translation>Fall, Volumen oder Archiv öffnen</translation>
        </message>
        <message>
            <source>Cases, volumes, archives, DICOMDIR (case.json *.nii *.nii.gz *.nrrd *.nhdr *.mha *.mhd *.zip DICOMDIR);;All files (*)</source>
            <translation>Fälle, Volumen, Archive, DICOMDIR (case.json *.nii *.nii.gz *.nrrd *.nhdr *.mha *.mhd *.zip DICOMDIR);;Alle Dateien (*)</translation>
        </message>
        <message>
            <source>Open &amp;case, volumes or archive…</source>
            <translation>&amp;Fall, Volumen oder Archiv öffnen…</translation>
        </message>
        <message>
            <source>&amp;Language</source>
            <translation>&amp;Sprache</translation>
        </message>
        <message>
            <source>The window speaks this language from its next start on.</source>
            <translation>Das Fenster spricht diese Sprache ab dem nächsten Start.</translation>
        </message>
        <message>
            <source>Built with these libraries, under their own licences:</source>
            <translation>Gebaut mit diesen Bibliotheken, unter deren eigenen Lizenzen:</translation>
        </message>
        <message>
            <source>&lt;p&gt;By the Glisson maintainers. It reproduces, and goes on from: Barrow et al., &lt;i&gt;Patient Specific Biomechanics Are Clinically Significant In Accurate Computer Aided Surgical Image Guidance&lt;/i&gt;. Cite that paper, and Glisson with its version.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Von den Glisson-Betreuern. Es vollzieht nach, und führt weiter: Barrow et al., &lt;i&gt;Patient Specific Biomechanics Are Clinically Significant In Accurate Computer Aided Surgical Image Guidance&lt;/i&gt;. Zitieren Sie diese Arbeit, und Glisson mit seiner Version.&lt;/p&gt;</translation>
        </message>
        <message>
            <source>Outline the liver first: there is nothing to retract.</source>
            <translation>Erst die Leber umranden: Es gibt nichts zu heben.</translation>
        </message>
        <message>
            <source>Open DICOM folder</source>
            <translation>DICOM-Ordner öffnen</translation>
        </message>
        <message>
            <source>Import outlines</source>
            <translation>Konturen importieren</translation>
        </message>
        <message>
            <source>Outlines (*.dcm *.json *.nii *.nii.gz *.nrrd *.mha);;All files (*)</source>
            <translation>Konturen (*.dcm *.json *.nii *.nii.gz *.nrrd *.mha);;Alle Dateien (*)</translation>
        </message>
        <message>
            <source>Save case into a folder</source>
            <translation>Fall in einen Ordner speichern</translation>
        </message>
        <message>
            <source>Save case</source>
            <translation>Fall speichern</translation>
        </message>
        <message>
            <source>Open case or archive</source>
            <translation>Fall oder Archiv öffnen</translation>
        </message>
        <message>
            <source>Cases, archives, DICOMDIR (case.json *.zip DICOMDIR);;All files (*)</source>
            <translation>Fälle, Archive, DICOMDIR (case.json *.zip DICOMDIR);;Alle Dateien (*)</translation>
        </message>
        <message>
            <source>A second reader's outlines</source>
            <translation>Konturen eines zweiten Befunders</translation>
        </message>
        <message>
            <source>Outlines and cases (*.json *.dcm);;All files (*)</source>
            <translation>Konturen und Fälle (*.json *.dcm);;Alle Dateien (*)</translation>
        </message>
        <message>
            <source>None yet</source>
            <translation>Noch keine</translation>
        </message>
        <message>
            <source>Glisson did not end in order. %1 outlines can be brought back%2.</source>
            <translation>Glisson wurde nicht ordentlich beendet. %1 Konturen lassen sich zurückholen%2.</translation>
        </message>
        <message>
            <source>, and the one being drawn</source>
            <translation>, auch die gerade gezeichnete</translation>
        </message>
        <message>
            <source>Recover</source>
            <translation>Zurückholen</translation>
        </message>
        <message>
            <source>Opens the patient and puts the outlines back</source>
            <translation>Öffnet den Patienten und setzt die Konturen wieder ein</translation>
        </message>
        <message>
            <source>Later</source>
            <translation>Später</translation>
        </message>
        <message>
            <source>Keeps it for the next start</source>
            <translation>Bewahrt sie bis zum nächsten Start</translation>
        </message>
        <message>
            <source>Discard</source>
            <translation>Verwerfen</translation>
        </message>
        <message>
            <source>Deletes what could be brought back</source>
            <translation>Löscht, was zurückgeholt werden könnte</translation>
        </message>
        <message>
            <source>&amp;File</source>
            <translation>&amp;Datei</translation>
        </message>
        <message>
            <source>&amp;Open DICOM folder…</source>
            <translation>DICOM-&amp;Ordner öffnen…</translation>
        </message>
        <message>
            <source>Open &amp;case or archive…</source>
            <translation>&amp;Fall oder Archiv öffnen…</translation>
        </message>
        <message>
            <source>&amp;Recent</source>
            <translation>&amp;Zuletzt</translation>
        </message>
        <message>
            <source>Synthetic &amp;patient</source>
            <translation>Synthetischer &amp;Patient</translation>
        </message>
        <message>
            <source>&amp;Import outlines…</source>
            <translation>Konturen &amp;importieren…</translation>
        </message>
        <message>
            <source>&amp;Save case</source>
            <translation>Fall &amp;speichern</translation>
        </message>
        <message>
            <source>Save case &amp;as…</source>
            <translation>Fall speichern &amp;unter…</translation>
        </message>
        <message>
            <source>&amp;Quit</source>
            <translation>&amp;Beenden</translation>
        </message>
        <message>
            <source>&amp;Edit</source>
            <translation>&amp;Bearbeiten</translation>
        </message>
        <message>
            <source>&amp;Undo</source>
            <translation>&amp;Rückgängig</translation>
        </message>
        <message>
            <source>&amp;Redo</source>
            <translation>&amp;Wiederherstellen</translation>
        </message>
        <message>
            <source>&amp;Interpolate between slices</source>
            <translation>Zwischen Schichten &amp;interpolieren</translation>
        </message>
        <message>
            <source>&amp;Accept all interpolated outlines</source>
            <translation>&amp;Alle interpolierten Konturen annehmen</translation>
        </message>
        <message>
            <source>Load a &amp;second reader's outlines…</source>
            <translation>Konturen eines &amp;zweiten Befunders laden…</translation>
        </message>
        <message>
            <source>&amp;Compare both readers</source>
            <translation>Beide Befunder &amp;vergleichen</translation>
        </message>
        <message>
            <source>&amp;Run</source>
            <translation>&amp;Rechnen</translation>
        </message>
        <message>
            <source>&amp;Build, retract and compare</source>
            <translation>&amp;Aufbauen, retrahieren und vergleichen</translation>
        </message>
        <message>
            <source>&amp;Cancel</source>
            <translation>&amp;Abbrechen</translation>
        </message>
        <message>
            <source>&amp;View</source>
            <translation>&amp;Ansicht</translation>
        </message>
        <message>
            <source>&amp;Dark theme</source>
            <translation>&amp;Dunkel</translation>
        </message>
        <message>
            <source>&amp;Light theme</source>
            <translation>&amp;Hell</translation>
        </message>
        <message>
            <source>&amp;Fit images</source>
            <translation>Bilder &amp;einpassen</translation>
        </message>
        <message>
            <source>&amp;Help</source>
            <translation>&amp;Hilfe</translation>
        </message>
        <message>
            <source>&amp;Keys and mouse</source>
            <translation>&amp;Tasten und Maus</translation>
        </message>
        <message>
            <source>&amp;About Glisson</source>
            <translation>&amp;Über Glisson</translation>
        </message>
        <message>
            <source>Cancel</source>
            <translation>Abbrechen</translation>
        </message>
        <message>
            <source>Cancelling</source>
            <translation>Wird abgebrochen</translation>
        </message>
        <message>
            <source>Two readers</source>
            <translation>Zwei Befunder</translation>
        </message>
        <message>
            <source>Saved, version %1.</source>
            <translation>Gespeichert, Version %1.</translation>
        </message>
        <message>
            <source>Not saved: %1 The outlines are kept.</source>
            <translation>Nicht gespeichert: %1 Die Konturen bleiben erhalten.</translation>
        </message>
        <message>
            <source>&amp;Undo %1</source>
            <translation>&amp;Rückgängig: %1</translation>
        </message>
        <message>
            <source>&amp;Redo %1</source>
            <translation>&amp;Wiederherstellen: %1</translation>
        </message>
        <message>
            <source>About Glisson</source>
            <translation>Über Glisson</translation>
        </message>
        <message>
            <source>&lt;h2&gt;Glisson %1&lt;/h2&gt;&lt;p&gt;&lt;b&gt;%2&lt;/b&gt;&lt;/p&gt;&lt;p&gt;Patient-specific biomechanics of the liver from MRI and MR elastography.&lt;/p&gt;&lt;p&gt;Numbers and reference ranges only, never a diagnosis.&lt;/p&gt;&lt;p&gt;Free software under the GNU General Public License, version 3 or later.&lt;/p&gt;</source>
            <translation>&lt;h2&gt;Glisson %1&lt;/h2&gt;&lt;p&gt;&lt;b&gt;%2&lt;/b&gt;&lt;/p&gt;&lt;p&gt;Patientenspezifische Biomechanik der Leber aus MRT und MR-Elastographie.&lt;/p&gt;&lt;p&gt;Nur Zahlen und Referenzbereiche, nie eine Diagnose.&lt;/p&gt;&lt;p&gt;Freie Software unter der GNU General Public License, Version 3 oder neuer.&lt;/p&gt;</translation>
        </message>
        <message>
            <source>Exported %1 files.</source>
            <translation>%1 Dateien exportiert.</translation>
        </message>
        <message>
            <source>Not exported: %1</source>
            <translation>Nicht exportiert: %1</translation>
        </message>
        <message>
            <source>Import them all the same? The answer is kept in the case.</source>
            <translation>Trotzdem importieren? Die Antwort steht im Fall.</translation>
        </message>
        <message>
            <source>Import</source>
            <translation>Importieren</translation>
        </message>
        <message>
            <source>Folder for pictures and report</source>
            <translation>Ordner für Bilder und Bericht</translation>
        </message>
        <message>
            <source>Glisson did not end in order. %1 outlines can be brought back%2, with the parameters as they were.</source>
            <translation>Glisson wurde nicht ordentlich beendet. %1 Konturen lassen sich zurückholen%2, mit den Parametern, wie sie waren.</translation>
        </message>
        <message>
            <source>What Glisson could bring back is deleted for good.</source>
            <translation>Was Glisson zurückholen könnte, wird endgültig gelöscht.</translation>
        </message>
        <message>
            <source>%1 outlines and the parameters are lost.</source>
            <translation>%1 Konturen und die Parameter gehen verloren.</translation>
        </message>
        <message>
            <source>Delete</source>
            <translation>Löschen</translation>
        </message>
        <message>
            <source>&amp;Export pictures and report…</source>
            <translation>Bilder und Bericht &amp;exportieren…</translation>
        </message>
        <message>
            <source>&amp;Put the second reader's outlines away</source>
            <translation>Konturen des zweiten Befunders &amp;weglegen</translation>
        </message>
        <message>
            <source>Outlines and parameters of this case are not saved.</source>
            <translation>Konturen und Parameter dieses Falls sind nicht gespeichert.</translation>
        </message>
        <message>
            <source>Outlines of this case are not saved.</source>
            <translation>Konturen dieses Falls sind nicht gespeichert.</translation>
        </message>
        <message>
            <source>Parameters of this case are not saved.</source>
            <translation>Parameter dieses Falls sind nicht gespeichert.</translation>
        </message>
        <message>
            <source>Not saved</source>
            <translation>Nicht gespeichert</translation>
        </message>
        <message>
            <source>Parameters are roles and answers about series, the model, bar, hoist and holds.</source>
            <translation>Parameter sind Rollen von Serien und Antworten zu ihnen, das Modell, Stab, Zug und gehaltene Blöcke.</translation>
        </message>
        <message>
            <source>Drafts and marks of slices are among them.</source>
            <translation>Entwürfe und Vermerke zu Schichten gehören dazu.</translation>
        </message>
        <message>
            <source>%1 outlines are there. Those of the file take their place.</source>
            <translation>%1 Konturen sind da. Die der Datei treten an ihre Stelle.</translation>
        </message>
        <message>
            <source>Undo brings them back, as long as this case is open.</source>
            <translation>Rückgängig holt sie zurück, solange dieser Fall offen ist.</translation>
        </message>
        <message>
            <source>Replace</source>
            <translation>Ersetzen</translation>
        </message>
        <message>
            <source>MRI and elastogram</source>
            <translation>MRT und Elastogramm</translation>
        </message>
        <message>
            <source>Use them together all the same? Yes is kept in the case and in the record of every run. No leaves the elastogram out: outlines can be drawn, stiffness is not measured.</source>
            <translation>Trotzdem zusammen verwenden? Ja steht dann im Fall und im Protokoll jedes Laufs. Bei Nein bleibt das Elastogramm weg: Konturen lassen sich zeichnen, Steifigkeit wird nicht gemessen.</translation>
        </message>
        <message>
            <source>What does the elastogram hold?</source>
            <translation>Was enthält das Elastogramm?</translation>
        </message>
        <message>
            <source>Shear modulus µ</source>
            <translation>Schubmodul µ</translation>
        </message>
        <message>
            <source>Young's modulus E</source>
            <translation>Elastizitätsmodul E</translation>
        </message>
        <message>
            <source>Choose</source>
            <translation>Wählen</translation>
        </message>
        <message>
            <source>Pa, kPa, or a factor before kPa: 0.01kPa where 350 stands for 3.5 kPa</source>
            <translation>Pa, kPa oder ein Faktor vor kPa: 0.01kPa, wenn 350 für 3.5 kPa steht</translation>
        </message>
        <message>
            <source>Quantity</source>
            <translation>Größe</translation>
        </message>
        <message>
            <source>Unit</source>
            <translation>Einheit</translation>
        </message>
        <message>
            <source>MR elastography reports the shear modulus unless it says otherwise; Young's modulus is about three times as large. The answer is kept in the case.</source>
            <translation>MR-Elastographie gibt den Schubmodul an, wenn sie nichts anderes sagt; der Elastizitätsmodul ist etwa dreimal so groß. Die Antwort steht im Fall.</translation>
        </message>
        <message>
            <source>Research use only, not for clinical use</source>
            <translation>Nur für die Forschung, nicht für die klinische Anwendung</translation>
        </message>
        <message>
            <source>&amp;Tools</source>
            <translation>&amp;Werkzeuge</translation>
        </message>
        <message>
            <source>&amp;Export DICOM, NIfTI, VTK, Slicer, SOFA…</source>
            <translation>DICOM, NIfTI, VTK, Slicer, SOFA &amp;exportieren…</translation>
        </message>
        <message>
            <source>&amp;Compare two runs…</source>
            <translation>Zwei Läufe &amp;vergleichen…</translation>
        </message>
        <message>
            <source>C&amp;ohort…</source>
            <translation>K&amp;ohorte…</translation>
        </message>
        <message>
            <source>&amp;PACS…</source>
            <translation>&amp;PACS…</translation>
        </message>
        <message>
            <source>&amp;De-identify a folder…</source>
            <translation>Einen Ordner pseu&amp;donymisieren…</translation>
        </message>
        <message>
            <source>P&amp;references…</source>
            <translation>&amp;Einstellungen…</translation>
        </message>
        <message>
            <source>Export</source>
            <translation>Exportieren</translation>
        </message>
        <message>
            <source>Theme</source>
            <translation>Farbschema</translation>
        </message>
        <message>
            <source>Language, from the next start on</source>
            <translation>Sprache, vom nächsten Start an</translation>
        </message>
        <message>
            <source>Mouse, over an image</source>
            <translation>Maus, über einem Bild</translation>
        </message>
        <message>
            <source>Keys</source>
            <translation>Tasten</translation>
        </message>
        <message>
            <source>Look at and change…</source>
            <translation>Ansehen und ändern…</translation>
        </message>
        <message>
            <source>PACS</source>
            <translation>PACS</translation>
        </message>
        <message>
            <source>Servers…</source>
            <translation>Server…</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::MethodChart</name>
        <message>
            <source>%1 ms</source>
            <translation>%1 ms</translation>
        </message>
        <message>
            <source>%1 s</source>
            <translation>%1 s</translation>
        </message>
        <message>
            <source>%1 mm</source>
            <translation>%1 mm</translation>
        </message>
        <message>
            <source>no answer</source>
            <translation>keine Lösung</translation>
        </message>
        <message>
            <source>Error and run time of every method</source>
            <translation>Fehler und Rechenzeit jedes Verfahrens</translation>
        </message>
        <message>
            <source>Method</source>
            <translation>Verfahren</translation>
        </message>
        <message>
            <source>Resolution</source>
            <translation>Auflösung</translation>
        </message>
        <message>
            <source>Run time</source>
            <translation>Rechenzeit</translation>
        </message>
        <message>
            <source>Largest error</source>
            <translation>Größter Fehler</translation>
        </message>
        <message>
            <source>Unknowns</source>
            <translation>Unbekannte</translation>
        </message>
        <message>
            <source>Measure on this patient</source>
            <translation>An diesem Patienten messen</translation>
        </message>
        <message>
            <source>Runs every method on this liver against a solution eight times as fine; about a minute</source>
            <translation>Rechnet jedes Verfahren an dieser Leber gegen eine achtmal so feine Lösung; etwa eine Minute</translation>
        </message>
        <message>
            <source>Cancel</source>
            <translation>Abbrechen</translation>
        </message>
        <message>
            <source>Stops measuring</source>
            <translation>Bricht die Messung ab</translation>
        </message>
        <message>
            <source>Error against run time on this patient</source>
            <translation>Fehler gegen Rechenzeit an diesem Patienten</translation>
        </message>
        <message>
            <source>Run time, model and solve (s)</source>
            <translation>Rechenzeit, Modell und Lösung (s)</translation>
        </message>
        <message>
            <source>Largest displacement error (mm)</source>
            <translation>Größter Fehler der Verschiebung (mm)</translation>
        </message>
        <message>
            <source>the default</source>
            <translation>die Vorgabe</translation>
        </message>
        <message>
            <source>your choice</source>
            <translation>Ihre Wahl</translation>
        </message>
        <message>
            <source>the default, your choice</source>
            <translation>die Vorgabe, Ihre Wahl</translation>
        </message>
        <message>
            <source>How exact is each method on this liver, and how long does it take?</source>
            <translation>Wie genau ist jedes Verfahren an dieser Leber, und wie lange braucht es?</translation>
        </message>
        <message>
            <source>Run the retraction first.</source>
            <translation>Zuerst die Retraktion rechnen.</translation>
        </message>
        <message>
            <source>  (default)</source>
            <translation>  (Vorgabe)</translation>
        </message>
        <message>
            <source>  (your choice)</source>
            <translation>  (Ihre Wahl)</translation>
        </message>
        <message>
            <source>Error: the largest distance from %1, over %2 places.</source>
            <translation>Fehler: der größte Abstand von %1, über %2 Orte.</translation>
        </message>
        <message>
            <source>%1 errs by at most %2 in %3%4.</source>
            <translation>%1 irrt um höchstens %2 in %3%4.</translation>
        </message>
        <message>
            <source>; nothing else is both faster and closer</source>
            <translation>; nichts anderes ist zugleich schneller und genauer</translation>
        </message>
        <message>
            <source>The default method</source>
            <translation>Das vorgegebene Verfahren</translation>
        </message>
        <message>
            <source>Your choice</source>
            <translation>Ihre Wahl</translation>
        </message>
        <message>
            <source>The method that you chose is not among those measured.</source>
            <translation>Das von Ihnen gewählte Verfahren ist nicht unter den gemessenen.</translation>
        </message>
        <message>
            <source>%1 variants were left out.</source>
            <translation>%1 Varianten wurden ausgelassen.</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::ModelPage</name>
        <message>
            <source>Plan</source>
            <translation>Plan</translation>
        </message>
        <message>
            <source>automatic (%1 mm)</source>
            <translation>automatisch (%1 mm)</translation>
        </message>
        <message>
            <source>Material</source>
            <translation>Material</translation>
        </message>
        <message>
            <source>kPa (µ)</source>
            <translation>kPa (µ)</translation>
        </message>
        <message>
            <source>Run</source>
            <translation>Rechnen</translation>
        </message>
        <message>
            <source>%1 cells, %2 mL, %3 kg</source>
            <translation>%1 Zellen, %2 mL, %3 kg</translation>
        </message>
        <message>
            <source>Step</source>
            <translation>Schritt</translation>
        </message>
        <message>
            <source>Needed</source>
            <translation>Nötig</translation>
        </message>
        <message>
            <source>Time</source>
            <translation>Zeit</translation>
        </message>
        <message>
            <source>MR elastogram</source>
            <translation>MR-Elastogramm</translation>
        </message>
        <message>
            <source>Atlas</source>
            <translation>Atlas</translation>
        </message>
        <message>
            <source>Shear modulus of the atlas model; healthy donors: 2.1 kPa</source>
            <translation>Schubmodul des Atlasmodells; gesunde Spender: 2,1 kPa</translation>
        </message>
        <message>
            <source>Poisson's ratio ν; 0.5 would be incompressible</source>
            <translation>Querkontraktionszahl ν; 0,5 wäre inkompressibel</translation>
        </message>
        <message>
            <source>Poisson's ratio ν</source>
            <translation>Querkontraktion ν</translation>
        </message>
        <message>
            <source>Mass density of the liver</source>
            <translation>Dichte der Leber</translation>
        </message>
        <message>
            <source>Density</source>
            <translation>Dichte</translation>
        </message>
        <message>
            <source>Discretisation</source>
            <translation>Diskretisierung</translation>
        </message>
        <message>
            <source>Method</source>
            <translation>Verfahren</translation>
        </message>
        <message>
            <source>Edge of a voxel cell: smaller is more exact and slower. 0 = twice the pixel of the MRI</source>
            <translation>Kante einer Voxelzelle: kleiner ist genauer und langsamer. 0 = doppelter Pixel des MRT</translation>
        </message>
        <message>
            <source>automatic</source>
            <translation>automatisch</translation>
        </message>
        <message>
            <source>Cell</source>
            <translation>Zelle</translation>
        </message>
        <message>
            <source>Number of mesh-free sites</source>
            <translation>Anzahl netzfreier Punkte</translation>
        </message>
        <message>
            <source>Sites</source>
            <translation>Punkte</translation>
        </message>
        <message>
            <source>Build, retract and compare (Ctrl+R)</source>
            <translation>Aufbauen, retrahieren und vergleichen (Strg+R)</translation>
        </message>
        <message>
            <source>no plan</source>
            <translation>kein Plan</translation>
        </message>
        <message>
            <source>yes</source>
            <translation>ja</translation>
        </message>
        <message>
            <source>
(of the last run; something has changed since)</source>
            <translation>
(vom letzten Lauf; seither hat sich etwas geändert)</translation>
        </message>
        <message>
            <source>Outline the liver first (step Segment).</source>
            <translation>Zuerst die Leber umranden (Schritt Segment).</translation>
        </message>
        <message>
            <source>Known after the first run.</source>
            <translation>Nach dem ersten Lauf bekannt.</translation>
        </message>
        <message>
            <source>What this case needs, what it leaves out, and why. Times are predicted before a run and measured after it.</source>
            <translation>Was dieser Fall braucht, was er weglässt, und warum. Zeiten sind vor einem Lauf geschätzt, danach gemessen.</translation>
        </message>
        <message>
            <source>Why</source>
            <translation>Warum</translation>
        </message>
        <message>
            <source>Model</source>
            <translation>Modell</translation>
        </message>
        <message>
            <source>Stiffness</source>
            <translation>Steifigkeit</translation>
        </message>
        <message>
            <source>Lay elastogram over MRI</source>
            <translation>Elastogramm auf MRT legen</translation>
        </message>
        <message>
            <source>The elastogram is of another breath-hold: moved rigidly until the magnitude images agree, before it is read</source>
            <translation>Das Elastogramm stammt aus einer anderen Atempause: es wird starr verschoben, bis die Magnitudenbilder übereinstimmen, dann gelesen</translation>
        </message>
        <message>
            <source>How the liver is divided; Compare shows error against run time of each</source>
            <translation>Wie die Leber zerlegt wird; Vergleichen zeigt Fehler gegen Rechenzeit für jedes Verfahren</translation>
        </message>
        <message>
            <source>Voxel FEM, incompatible modes</source>
            <translation>Voxel-FEM, inkompatible Moden</translation>
        </message>
        <message>
            <source>Hexahedra that bend without locking: the default</source>
            <translation>Hexaeder, die sich biegen, ohne zu sperren: die Vorgabe</translation>
        </message>
        <message>
            <source>Voxel FEM, B-bar</source>
            <translation>Voxel-FEM, B-Quer</translation>
        </message>
        <message>
            <source>Hexahedra that do not lock where nearly incompressible</source>
            <translation>Hexaeder, die fast inkompressibel nicht sperren</translation>
        </message>
        <message>
            <source>Voxel FEM, trilinear</source>
            <translation>Voxel-FEM, trilinear</translation>
        </message>
        <message>
            <source>The plain hexahedron; too stiff in bending</source>
            <translation>Der einfache Hexaeder; bei Biegung zu steif</translation>
        </message>
        <message>
            <source>Tetrahedra, quadratic</source>
            <translation>Tetraeder, quadratisch</translation>
        </message>
        <message>
            <source>Six ten-node tetrahedra per voxel</source>
            <translation>Sechs Tetraeder mit zehn Knoten je Voxel</translation>
        </message>
        <message>
            <source>Tetrahedra, linear</source>
            <translation>Tetraeder, linear</translation>
        </message>
        <message>
            <source>Six four-node tetrahedra per voxel; too stiff</source>
            <translation>Sechs Tetraeder mit vier Knoten je Voxel; zu steif</translation>
        </message>
        <message>
            <source>Delaunay, quadratic</source>
            <translation>Delaunay, quadratisch</translation>
        </message>
        <message>
            <source>Ten-node tetrahedra that follow the smooth surface</source>
            <translation>Tetraeder mit zehn Knoten, die der glatten Oberfläche folgen</translation>
        </message>
        <message>
            <source>Delaunay, linear</source>
            <translation>Delaunay, linear</translation>
        </message>
        <message>
            <source>Four-node tetrahedra that follow the smooth surface</source>
            <translation>Tetraeder mit vier Knoten, die der glatten Oberfläche folgen</translation>
        </message>
        <message>
            <source>Mesh-free, Wendland</source>
            <translation>Netzfrei, Wendland</translation>
        </message>
        <message>
            <source>Frames with affine motion, Wendland kernel</source>
            <translation>Rahmen mit affiner Bewegung, Wendland-Kern</translation>
        </message>
        <message>
            <source>Mesh-free, Wendland quadratic</source>
            <translation>Netzfrei, Wendland quadratisch</translation>
        </message>
        <message>
            <source>Frames with quadratic motion</source>
            <translation>Rahmen mit quadratischer Bewegung</translation>
        </message>
        <message>
            <source>Mesh-free, Voronoi</source>
            <translation>Netzfrei, Voronoi</translation>
        </message>
        <message>
            <source>Frames with affine motion, Voronoi kernel as published</source>
            <translation>Rahmen mit affiner Bewegung, Voronoi-Kern wie veröffentlicht</translation>
        </message>
        <message>
            <source>Mesh-free, moving least squares</source>
            <translation>Netzfrei, Moving Least Squares</translation>
        </message>
        <message>
            <source>Element-free Galerkin: three degrees of freedom per site</source>
            <translation>Elementfreies Galerkin-Verfahren: drei Freiheitsgrade je Stützstelle</translation>
        </message>
        <message>
            <source>Edge of the tetrahedra</source>
            <translation>Kante der Tetraeder</translation>
        </message>
        <message>
            <source>Edge</source>
            <translation>Kante</translation>
        </message>
        <message>
            <source>Edge of the tetrahedra near the retractor, at most that of the others</source>
            <translation>Kante der Tetraeder nahe dem Retraktor, höchstens die der übrigen</translation>
        </message>
        <message>
            <source>At the tool</source>
            <translation>Am Retraktor</translation>
        </message>
        <message>
            <source>Equations</source>
            <translation>Gleichungen</translation>
        </message>
        <message>
            <source>How strain follows from displacement; other than linear for voxel FEM at rest</source>
            <translation>Wie die Dehnung aus der Verschiebung folgt; anders als linear nur für Voxel-FEM in Ruhe</translation>
        </message>
        <message>
            <source>Linear</source>
            <translation>Linear</translation>
        </message>
        <message>
            <source>Corotational</source>
            <translation>Korotational</translation>
        </message>
        <message>
            <source>Hyperelastic</source>
            <translation>Hyperelastisch</translation>
        </message>
        <message>
            <source>Deformation</source>
            <translation>Verformung</translation>
        </message>
        <message>
            <source>One solve for the new rest, or time steps towards it</source>
            <translation>Eine Lösung für die neue Ruhelage, oder Zeitschritte dorthin</translation>
        </message>
        <message>
            <source>At rest</source>
            <translation>In Ruhe</translation>
        </message>
        <message>
            <source>Time steps</source>
            <translation>Zeitschritte</translation>
        </message>
        <message>
            <source>Analysis</source>
            <translation>Analyse</translation>
        </message>
        <message>
            <source>Length of an implicit time step</source>
            <translation>Länge eines impliziten Zeitschritts</translation>
        </message>
        <message>
            <source>Stops before where nothing moves any more</source>
            <translation>Endet früher, wenn sich nichts mehr bewegt</translation>
        </message>
        <message>
            <source>Until</source>
            <translation>Bis</translation>
        </message>
        <message>
            <source>Who solves the equations; automatic takes the fastest for the size</source>
            <translation>Wer die Gleichungen löst; automatisch nimmt den schnellsten für die Größe</translation>
        </message>
        <message>
            <source>Automatic</source>
            <translation>Automatisch</translation>
        </message>
        <message>
            <source>Conjugate gradients</source>
            <translation>Konjugierte Gradienten</translation>
        </message>
        <message>
            <source>Multigrid</source>
            <translation>Mehrgitter</translation>
        </message>
        <message>
            <source>Factorised</source>
            <translation>Faktorisiert</translation>
        </message>
        <message>
            <source>Condensed</source>
            <translation>Kondensiert</translation>
        </message>
        <message>
            <source>Solver</source>
            <translation>Löser</translation>
        </message>
        <message>
            <source>Liver</source>
            <translation>Leber</translation>
        </message>
        <message>
            <source>%1%2 s</source>
            <translation>%1%2 s</translation>
        </message>
        <message>
            <source>left out</source>
            <translation>ausgelassen</translation>
        </message>
        <message>
            <source>Say how sure</source>
            <translation>Sagen, wie sicher</translation>
        </message>
        <message>
            <source>Intervals, the chance of 5 mm and what drives them, under a rigid bar; takes about four times as long</source>
            <translation>Intervalle, die Wahrscheinlichkeit von 5 mm und was sie bestimmt, unter einem starren Stab; dauert etwa viermal so lang</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::ModelStage</name>
        <message>
            <source>The model in 3-D</source>
            <translation>Das Modell in 3-D</translation>
        </message>
        <message>
            <source>Surface</source>
            <translation>Oberfläche</translation>
        </message>
        <message>
            <source>The liver's surface</source>
            <translation>Die Oberfläche der Leber</translation>
        </message>
        <message>
            <source>Stiffness</source>
            <translation>Steifigkeit</translation>
        </message>
        <message>
            <source>Shear modulus of the cells below the surface, by colour</source>
            <translation>Schubmodul der Zellen unter der Oberfläche, als Farbe</translation>
        </message>
        <message>
            <source>Vessels</source>
            <translation>Gefäße</translation>
        </message>
        <message>
            <source>Hepatic vessels found in the MRI</source>
            <translation>Lebergefäße, im MRT gefunden</translation>
        </message>
        <message>
            <source>Sites</source>
            <translation>Stützstellen</translation>
        </message>
        <message>
            <source>Nodes of the cells, or mesh-free sites: where the model moves</source>
            <translation>Knoten der Zellen oder netzfreie Stützstellen: wo sich das Modell bewegt</translation>
        </message>
        <message>
            <source>Supports</source>
            <translation>Lager</translation>
        </message>
        <message>
            <source>What holds the liver: springs and fixed blocks</source>
            <translation>Was die Leber hält: Federn und feste Blöcke</translation>
        </message>
        <message>
            <source>Retractor</source>
            <translation>Retraktor</translation>
        </message>
        <message>
            <source>The bar and the direction of its hoist</source>
            <translation>Der Stab und die Richtung seines Zugs</translation>
        </message>
        <message>
            <source>Colour scale of the stiffness</source>
            <translation>Farbskala der Steifigkeit</translation>
        </message>
        <message>
            <source>0–8 kPa</source>
            <translation>0–8 kPa</translation>
        </message>
        <message>
            <source>0–20 kPa</source>
            <translation>0–20 kPa</translation>
        </message>
        <message>
            <source>Building the model…</source>
            <translation>Das Modell entsteht…</translation>
        </message>
        <message>
            <source>hoist</source>
            <translation>Zug</translation>
        </message>
        <message>
            <source>held %1</source>
            <translation>Halt %1</translation>
        </message>
        <message>
            <source>Shear modulus of the cells: mean %1, from %2 to %3 kPa.</source>
            <translation>Schubmodul der Zellen: im Mittel %1, von %2 bis %3 kPa.</translation>
        </message>
        <message>
            <source>%1 mesh-free sites</source>
            <translation>%1 netzfreie Stützstellen</translation>
        </message>
        <message>
            <source>%1 nodes of cells</source>
            <translation>%1 Knoten der Zellen</translation>
        </message>
        <message>
            <source>, all shown.</source>
            <translation>, alle gezeigt.</translation>
        </message>
        <message>
            <source>, %1 of them shown.</source>
            <translation>, %1 davon gezeigt.</translation>
        </message>
        <message>
            <source>No vessels were found in the MRI.</source>
            <translation>Im MRT wurden keine Gefäße gefunden.</translation>
        </message>
        <message>
            <source>a block</source>
            <translation>ein Block</translation>
        </message>
        <message>
            <source>posterior surface</source>
            <translation>hintere Oberfläche</translation>
        </message>
        <message>
            <source>superior surface</source>
            <translation>obere Oberfläche</translation>
        </message>
        <message>
            <source>Fixed (orange): %1.</source>
            <translation>Fest (orange): %1.</translation>
        </message>
        <message>
            <source>Springs (turquoise): %1.</source>
            <translation>Federn (türkis): %1.</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::OutlinePanel</name>
        <message>
            <source>Over the MRI</source>
            <translation>Über der MRT</translation>
        </message>
        <message>
            <source>Stiffness over the MRI</source>
            <translation>Steifigkeit über der MRT</translation>
        </message>
        <message>
            <source>What counts: outlines that were accepted or interpolated, without what is left out, empty slices between them filled by shape</source>
            <translation>Was zählt: angenommene und interpolierte Konturen ohne das Ausgelassene, leere Schichten dazwischen nach der Form gefüllt</translation>
        </message>
        <message>
            <source>Volume %1 mL</source>
            <translation>Volumen %1 mL</translation>
        </message>
        <message>
            <source>Outline the liver</source>
            <translation>Leber umfahren</translation>
        </message>
        <message>
            <source>Accept</source>
            <translation>Annehmen</translation>
        </message>
        <message>
            <source>Stiffness under the outline</source>
            <translation>Steifigkeit in der Kontur</translation>
        </message>
        <message>
            <source>Inner region</source>
            <translation>Innenbereich</translation>
        </message>
        <message>
            <source> px</source>
            <translation> px</translation>
        </message>
        <message>
            <source>Pixels of the elastogram taken off the edge ([ and ])</source>
            <translation>Pixel des Elastogramms, die am Rand wegfallen ([ und ])</translation>
        </message>
        <message>
            <source>Colour scale</source>
            <translation>Farbskala</translation>
        </message>
        <message>
            <source>0 – %1 kPa</source>
            <translation>0 – %1 kPa</translation>
        </message>
        <message>
            <source>Outlines</source>
            <translation>Konturen</translation>
        </message>
        <message>
            <source>Slice</source>
            <translation>Schicht</translation>
        </message>
        <message>
            <source>Vertices</source>
            <translation>Punkte</translation>
        </message>
        <message>
            <source>State</source>
            <translation>Zustand</translation>
        </message>
        <message>
            <source>Interpolate</source>
            <translation>Interpolieren</translation>
        </message>
        <message>
            <source>Accept all</source>
            <translation>Alle annehmen</translation>
        </message>
        <message>
            <source>Import outlines…</source>
            <translation>Konturen importieren…</translation>
        </message>
        <message>
            <source>RT Structure Set, contour file or mask (Ctrl+I)</source>
            <translation>RT Structure Set, Konturdatei oder Maske (Strg+I)</translation>
        </message>
        <message>
            <source>%1 px → %2 after mask, %3 cm², %4 ± %5 kPa (µ)</source>
            <translation>%1 px → %2 nach Maske, %3 cm², %4 ± %5 kPa (µ)</translation>
        </message>
        <message>
            <source>Inner region, %1 pixels off the edge</source>
            <translation>Innenbereich, %1 Pixel vom Rand</translation>
        </message>
        <message>
            <source>%1 ± %2 kPa</source>
            <translation>%1 ± %2 kPa</translation>
        </message>
        <message>
            <source>All slices: </source>
            <translation>Alle Schichten: </translation>
        </message>
        <message>
            <source>This slice: </source>
            <translation>Diese Schicht: </translation>
        </message>
        <message>
            <source>left out</source>
            <translation>ausgenommen</translation>
        </message>
        <message>
            <source>drawn</source>
            <translation>gezeichnet</translation>
        </message>
        <message>
            <source>interpolated</source>
            <translation>interpoliert</translation>
        </message>
        <message>
            <source>draft</source>
            <translation>Entwurf</translation>
        </message>
        <message>
            <source>empty</source>
            <translation>leer</translation>
        </message>
        <message>
            <source>no liver</source>
            <translation>keine Leber</translation>
        </message>
        <message>
            <source>no wave</source>
            <translation>keine Welle</translation>
        </message>
        <message>
            <source>%1 drawn, %2 interpolated, %3 empty between them.</source>
            <translation>%1 gezeichnet, %2 interpoliert, %3 leere dazwischen.</translation>
        </message>
        <message>
            <source>A run fills these by shape.</source>
            <translation>Eine Rechnung füllt diese nach der Form.</translation>
        </message>
        <message>
            <source>Undo %1 (%2)</source>
            <translation>Rückgängig: %1 (%2)</translation>
        </message>
        <message>
            <source>Redo %1 (%2)</source>
            <translation>Wiederherstellen: %1 (%2)</translation>
        </message>
        <message>
            <source>Close</source>
            <translation>Schließen</translation>
        </message>
        <message>
            <source>Drag to push the outline with the disc; [ and ] change its size.</source>
            <translation>Ziehen schiebt die Kontur mit der Scheibe; [ und ] ändern ihre Größe.</translation>
        </message>
        <message>
            <source>Click vertices on the MRI, or drag to draw freehand. Click an outline to edit it.</source>
            <translation>Punkte auf der MRT anklicken, oder durch Ziehen freihändig zeichnen. Klick auf eine Kontur bearbeitet sie.</translation>
        </message>
        <message>
            <source>Close on the first vertex, with a right click, a double click or Enter. Backspace takes the last vertex back, Esc parks a draft.</source>
            <translation>Schließen am ersten Punkt, mit Rechtsklick, Doppelklick oder Eingabe. Rücktaste nimmt den letzten Punkt zurück, Esc legt einen Entwurf ab.</translation>
        </message>
        <message>
            <source>Interpolated between drawn slices. Enter accepts it, correcting it accepts it too; an outline drawn on this slice replaces it.</source>
            <translation>Zwischen gezeichneten Schichten interpoliert. Eingabe nimmt an, Korrigieren ebenso; eine hier gezeichnete Kontur ersetzt sie.</translation>
        </message>
        <message>
            <source>Drag vertices to adjust; Ctrl+click adds or deletes one. Enter accepts.</source>
            <translation>Punkte ziehen; Strg+Klick fügt einen ein oder löscht ihn. Eingabe nimmt an.</translation>
        </message>
        <message>
            <source>Accepted. It can still be edited; click beside it to draw the next.</source>
            <translation>Angenommen. Bleibt bearbeitbar; ein Klick daneben beginnt die nächste.</translation>
        </message>
        <message>
            <source>Median, smallest and largest value, mean weighted by area</source>
            <translation>Median, kleinster und größter Wert, nach Fläche gewichtetes Mittel</translation>
        </message>
        <message>
            <source>Fewer numbers</source>
            <translation>Weniger Zahlen</translation>
        </message>
        <message>
            <source>More numbers</source>
            <translation>Mehr Zahlen</translation>
        </message>
        <message>
            <source>median %1, smallest %2, largest %3 kPa (µ)</source>
            <translation>Median %1, kleinster %2, größter %3 kPa (µ)</translation>
        </message>
        <message>
            <source>; mean weighted by area %1 kPa (µ)</source>
            <translation>; nach Fläche gewichtetes Mittel %1 kPa (µ)</translation>
        </message>
        <message>
            <source>This slice lies between elastography slices; slice %1 counts there.</source>
            <translation>Diese Schicht liegt zwischen Schichten der Elastographie; dort zählt Schicht %1.</translation>
        </message>
        <message>
            <source>Drag an ellipse from corner to corner; with Shift a circle.</source>
            <translation>Eine Ellipse von Ecke zu Ecke ziehen; mit Umschalt einen Kreis.</translation>
        </message>
        <message>
            <source>Paint on tissue: the disc keeps to what looks like where it was pressed, with Shift it takes all. [ and ] change its size.</source>
            <translation>Auf Gewebe malen: die Scheibe hält sich an das, was so aussieht wie dort, wo gedrückt wurde; mit Umschalt nimmt sie alles. [ und ] ändern ihre Größe.</translation>
        </message>
        <message>
            <source>Erase parts of outlines: the disc keeps to what looks like where it was pressed, with Shift it takes all. [ and ] change its size.</source>
            <translation>Teile von Konturen wegradieren: die Scheibe hält sich an das, was so aussieht wie dort, wo gedrückt wurde; mit Umschalt nimmt sie alles. [ und ] ändern ihre Größe.</translation>
        </message>
        <message>
            <source>Click along a border: the line follows the edges of the image from click to click.</source>
            <translation>Entlang einer Grenze klicken: die Linie folgt den Kanten des Bildes von Klick zu Klick.</translation>
        </message>
        <message>
            <source>Click points on the border: a smooth closed curve runs through them.</source>
            <translation>Punkte auf der Grenze klicken: eine glatte geschlossene Kurve läuft durch sie.</translation>
        </message>
        <message>
            <source>proposed</source>
            <translation>vorgeschlagen</translation>
        </message>
        <message>
            <source>copied</source>
            <translation>kopiert</translation>
        </message>
        <message>
            <source>%1, accepted</source>
            <translation>%1, angenommen</translation>
        </message>
        <message>
            <source>%1 drawn</source>
            <translation>%1 gezeichnet</translation>
        </message>
        <message>
            <source>%1 interpolated</source>
            <translation>%1 interpoliert</translation>
        </message>
        <message>
            <source>%1 proposed</source>
            <translation>%1 vorgeschlagen</translation>
        </message>
        <message>
            <source>%1 copied</source>
            <translation>%1 kopiert</translation>
        </message>
        <message>
            <source>%1 empty between them</source>
            <translation>%1 dazwischen leer</translation>
        </message>
        <message>
            <source>Of those that nobody drew %1 were accepted; all count.</source>
            <translation>Von denen, die niemand gezeichnet hat, sind %1 angenommen; alle zählen.</translation>
        </message>
        <message>
            <source>Drafts do not count (slices %1).</source>
            <translation>Entwürfe zählen nicht (Schichten %1).</translation>
        </message>
        <message>
            <source>Repeatability coefficient of the QIBA profile for liver MR elastography, 2022: a change by 19 % of the mean or more is a true one with 95 % confidence.</source>
            <translation>Wiederholbarkeitskoeffizient des QIBA-Profils für MR-Elastographie der Leber, 2022: Eine Änderung um 19 % des Mittels oder mehr ist mit 95 % Sicherheit eine wirkliche.</translation>
        </message>
        <message>
            <source>A change is real from %1 kPa (19 %).</source>
            <translation>Eine Änderung ist ab %1 kPa wirklich (19 %).</translation>
        </message>
        <message>
            <source>%1 % of the outline measured.</source>
            <translation>%1 % des Umrisses gemessen.</translation>
        </message>
        <message>
            <source>Too small for an inner region: the edge counts.</source>
            <translation>Zu klein für eine innere Region: Der Rand zählt mit.</translation>
        </message>
        <message>
            <source>The region is small (%1 of at least %2 mm²): a few waves decide.</source>
            <translation>Die Region ist klein (%1 von mindestens %2 mm²): Wenige Wellen entscheiden.</translation>
        </message>
        <message>
            <source>Technical failure on %1 slices: no reliable wave.</source>
            <translation>Technisches Versagen auf %1 Schichten: keine verlässliche Welle.</translation>
        </message>
        <message>
            <source>This slice is a technical failure: no reliable wave.</source>
            <translation>Diese Schicht ist ein technisches Versagen: keine verlässliche Welle.</translation>
        </message>
        <message>
            <source>Of this slice less than a tenth has a reliable wave.</source>
            <translation>Von dieser Schicht hat weniger als ein Zehntel eine verlässliche Welle.</translation>
        </message>
        <message>
            <source>Of this slice less than %1 mm² count.</source>
            <translation>Von dieser Schicht zählen weniger als %1 mm².</translation>
        </message>
        <message>
            <source>Acquired by %1.</source>
            <translation>Aufgenommen mit %1.</translation>
        </message>
        <message>
            <source>Left out: edge %1 px, vessels %2 px; that changes the mean by %3 % (%4 kPa with them).</source>
            <translation>Weggelassen: Rand %1 px, Gefäße %2 px; das ändert das Mittel um %3 % (%4 kPa mit ihnen).</translation>
        </message>
        <message>
            <source>Without vessels</source>
            <translation>Ohne Gefäße</translation>
        </message>
        <message>
            <source>Vessels found in the MRI are not measured. They are looked for once the outlines rest.</source>
            <translation>Im MRT gefundene Gefäße werden nicht gemessen. Sie werden gesucht, sobald die Umrisse ruhen.</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::PlacementEditor</name>
        <message>
            <source>Hold here…</source>
            <translation>Hier halten…</translation>
        </message>
        <message>
            <source>Then click on the liver: a block that is held fixed</source>
            <translation>Dann auf die Leber klicken: ein Block, der festgehalten wird</translation>
        </message>
        <message>
            <source>Edge of the block that is held</source>
            <translation>Kante des festgehaltenen Blocks</translation>
        </message>
        <message>
            <source>Remove</source>
            <translation>Entfernen</translation>
        </message>
        <message>
            <source>Takes the chosen block away (Delete)</source>
            <translation>Nimmt den gewählten Block weg (Entf)</translation>
        </message>
        <message>
            <source>Bar as proposed</source>
            <translation>Stab wie vorgeschlagen</translation>
        </message>
        <message>
            <source>Back under the inferior right lobe, across the patient, hoisted towards anterior</source>
            <translation>Zurück unter den unteren rechten Lappen, quer zum Patienten, nach vorn gezogen</translation>
        </message>
        <message>
            <source>Building the model…</source>
            <translation>Das Modell entsteht…</translation>
        </message>
        <message>
            <source>held %1</source>
            <translation>Halt %1</translation>
        </message>
        <message>
            <source>%1 mm</source>
            <translation>%1 mm</translation>
        </message>
        <message>
            <source>hoist</source>
            <translation>Zug</translation>
        </message>
        <message>
            <source>bar</source>
            <translation>Stab</translation>
        </message>
        <message>
            <source>Bar at %1%2, ∅ %3 mm, length %4 mm; hoisted along (%5, %6, %7).</source>
            <translation>Stab bei %1%2, ∅ %3 mm, Länge %4 mm; gezogen entlang (%5, %6, %7).</translation>
        </message>
        <message>
            <source> (as proposed)</source>
            <translation> (wie vorgeschlagen)</translation>
        </message>
        <message>
            <source>Held %1: block of %2 mm at %3.</source>
            <translation>Halt %1: Block von %2 mm bei %3.</translation>
        </message>
        <message>
            <source>Drag the handles in 3-D or on the slice. Each drag can be undone.</source>
            <translation>Die Griffe in 3-D oder auf der Schicht ziehen. Jeder Zug lässt sich zurücknehmen.</translation>
        </message>
        <message>
            <source>move what is held</source>
            <translation>Halt verschieben</translation>
        </message>
        <message>
            <source>move the bar</source>
            <translation>Stab verschieben</translation>
        </message>
        <message>
            <source>turn the bar</source>
            <translation>Stab drehen</translation>
        </message>
        <message>
            <source>turn the hoist</source>
            <translation>Zug drehen</translation>
        </message>
        <message>
            <source>hold the liver</source>
            <translation>Leber halten</translation>
        </message>
        <message>
            <source>release the liver</source>
            <translation>Leber loslassen</translation>
        </message>
        <message>
            <source>bar as proposed</source>
            <translation>Stab wie vorgeschlagen</translation>
        </message>
        <message>
            <source>size of what is held</source>
            <translation>Größe des Halts</translation>
        </message>
        <message>
            <source> (proposed from the liver&apos;s shape; the run proves that it bears)</source>
            <translation> (nach der Form der Leber vorgeschlagen; dass die Stelle trägt, zeigt die Rechnung)</translation>
        </message>
        <message>
            <source> (where the run has laid it)</source>
            <translation> (wohin die Rechnung ihn gelegt hat)</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::RetractPage</name>
        <message>
            <source>Straight to the end of the time steps, not their course.</source>
            <translation>Geradewegs zum Ende der Zeitschritte, nicht ihr Verlauf.</translation>
        </message>
        <message>
            <source>Play the retraction</source>
            <translation>Retraktion abspielen</translation>
        </message>
        <message>
            <source>%1 %</source>
            <translation>%1 %</translation>
        </message>
        <message>
            <source>Retraction</source>
            <translation>Retraktion</translation>
        </message>
        <message>
            <source>Solution</source>
            <translation>Lösung</translation>
        </message>
        <message>
            <source>Run</source>
            <translation>Rechnen</translation>
        </message>
        <message>
            <source>Build, retract and compare (Ctrl+R)</source>
            <translation>Aufbauen, retrahieren und vergleichen (Strg+R)</translation>
        </message>
        <message>
            <source>Not run yet.</source>
            <translation>Noch nicht gerechnet.</translation>
        </message>
        <message>
            <source>%1: %2 iterations, residual %3
%4 degrees of freedom
Load %5 N, reaction %6 N
Largest strain %7 %, rotation %8°</source>
            <translation>%1: %2 Iterationen, Residuum %3
%4 Freiheitsgrade
Last %5 N, Reaktion %6 N
Größte Dehnung %7 %, Drehung %8°</translation>
        </message>
        <message>
            <source>Linear theory can be trusted here.</source>
            <translation>Der linearen Theorie ist hier zu trauen.</translation>
        </message>
        <message>
            <source>The retraction in 3-D</source>
            <translation>Die Retraktion in 3-D</translation>
        </message>
        <message>
            <source>MRI slice with bar and holds</source>
            <translation>MRT-Schicht mit Stab und Halten</translation>
        </message>
        <message>
            <source>MRI</source>
            <translation>MRT</translation>
        </message>
        <message>
            <source>Place by hand</source>
            <translation>Von Hand setzen</translation>
        </message>
        <message>
            <source>Play and move live</source>
            <translation>Abspielen und live bewegen</translation>
        </message>
        <message>
            <source>Shows the last run: play it, go through it, take the retractor into your hand</source>
            <translation>Zeigt die letzte Rechnung: abspielen, durchgehen, den Retraktor in die Hand nehmen</translation>
        </message>
        <message>
            <source>Drag bar, bar ends, hoist and holds; then Run.</source>
            <translation>Stab, Stabenden, Zug und Halterungen ziehen; dann rechnen.</translation>
        </message>
        <message>
            <source>Changed since the run: Run again to see what it does.</source>
            <translation>Seit der Rechnung geändert: neu rechnen, um die Wirkung zu sehen.</translation>
        </message>
        <message>
            <source>Shows the liver at rest: lay the bar, turn its hoist, hold the liver, in 3-D or on a slice</source>
            <translation>Zeigt die Leber in Ruhe: den Stab legen, seinen Zug drehen, die Leber halten, in 3-D oder auf einer Schicht</translation>
        </message>
        <message>
            <source>Straight from first touch to the end, not the course of the bar.</source>
            <translation>Geradewegs von der ersten Berührung zum Ende, nicht der Verlauf des Bügels.</translation>
        </message>
        <message>
            <source>The large deformation converged.</source>
            <translation>Die große Verformung ist konvergiert.</translation>
        </message>
        <message>
            <source>How far to trust it</source>
            <translation>Wie weit dem zu trauen ist</translation>
        </message>
        <message>
            <source>Drafts do not count (slices %1): accept or delete them on Segment first.</source>
            <translation>Entwürfe zählen nicht (Schichten %1): erst auf Segmentieren annehmen oder löschen.</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::SegmentPage</name>
        <message>
            <source>Every slice is outlined or marked.</source>
            <translation>Jede Schicht ist umfahren oder markiert.</translation>
        </message>
        <message>
            <source>The views move together.</source>
            <translation>Die Ansichten bewegen sich gemeinsam.</translation>
        </message>
        <message>
            <source>The views move on their own.</source>
            <translation>Jede Ansicht bewegt sich für sich.</translation>
        </message>
        <message>
            <source>Copy to slices…</source>
            <translation>Auf Schichten kopieren…</translation>
        </message>
        <message>
            <source>Properties and statistics…</source>
            <translation>Eigenschaften und Statistik…</translation>
        </message>
        <message>
            <source>Copy to slices</source>
            <translation>Auf Schichten kopieren</translation>
        </message>
        <message>
            <source>Copy to all empty slices up to slice:</source>
            <translation>Auf alle leeren Schichten kopieren bis Schicht:</translation>
        </message>
        <message>
            <source>none</source>
            <translation>keine</translation>
        </message>
        <message>
            <source>%1 cm²</source>
            <translation>%1 cm²</translation>
        </message>
        <message>
            <source>%1 ± %2 kPa (µ), %3 of %4 pixels count</source>
            <translation>%1 ± %2 kPa (µ), %3 von %4 Pixeln zählen</translation>
        </message>
        <message>
            <source>left out</source>
            <translation>ausgenommen</translation>
        </message>
        <message>
            <source>accepted</source>
            <translation>angenommen</translation>
        </message>
        <message>
            <source>interpolated</source>
            <translation>interpoliert</translation>
        </message>
        <message>
            <source>draft</source>
            <translation>Entwurf</translation>
        </message>
        <message>
            <source>Outline on slice %1</source>
            <translation>Kontur auf Schicht %1</translation>
        </message>
        <message>
            <source>%1 vertices, %2
Area: %3
Stiffness on this slice: %4

Name of the region:</source>
            <translation>%1 Punkte, %2
Fläche: %3
Steifigkeit auf dieser Schicht: %4

Name des Bereichs:</translation>
        </message>
        <message>
            <source>Open images first (step Load).</source>
            <translation>Zuerst Bilder öffnen (Schritt Laden).</translation>
        </message>
        <message>
            <source>No elastogram is open.</source>
            <translation>Kein Elastogramm ist geöffnet.</translation>
        </message>
        <message>
            <source>MRI slice</source>
            <translation>MRT-Schicht</translation>
        </message>
        <message>
            <source>Elastography slice</source>
            <translation>Elastographie-Schicht</translation>
        </message>
        <message>
            <source>Window and level of the MRI (0 to 5)</source>
            <translation>Fenster der MRT (0 bis 5)</translation>
        </message>
        <message>
            <source>Auto</source>
            <translation>Auto</translation>
        </message>
        <message>
            <source>Soft</source>
            <translation>Weich</translation>
        </message>
        <message>
            <source>Liver</source>
            <translation>Leber</translation>
        </message>
        <message>
            <source>Vessels</source>
            <translation>Gefäße</translation>
        </message>
        <message>
            <source>Bright</source>
            <translation>Hell</translation>
        </message>
        <message>
            <source>Dark</source>
            <translation>Dunkel</translation>
        </message>
        <message>
            <source>Under the cursor: %1 kPa (µ)</source>
            <translation>Unter dem Zeiger: %1 kPa (µ)</translation>
        </message>
        <message>
            <source>MRI</source>
            <translation>MRT</translation>
        </message>
        <message>
            <source>no liver</source>
            <translation>keine Leber</translation>
        </message>
        <message>
            <source>no reliable wave</source>
            <translation>keine verlässliche Welle</translation>
        </message>
        <message>
            <source> px</source>
            <translation> px</translation>
        </message>
        <message>
            <source>Freehand: a vertex every so many pixels of the screen</source>
            <translation>Freihand: so viele Bildschirmpixel von Punkt zu Punkt</translation>
        </message>
        <message>
            <source>Spacing of freehand vertices</source>
            <translation>Abstand der Freihand-Punkte</translation>
        </message>
        <message>
            <source>The stiffness scale is 0–8 or 0–20 kPa, so that a colour always means the same: %1.</source>
            <translation>Die Steifigkeitsskala geht bis 8 oder bis 20 kPa, damit eine Farbe immer dasselbe bedeutet: %1.</translation>
        </message>
        <message>
            <source>Nothing on this slice waits to be accepted.</source>
            <translation>Auf dieser Schicht wartet nichts darauf, angenommen zu werden.</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::StepRail</name>
        <message>
            <source>Load</source>
            <translation>Laden</translation>
        </message>
        <message>
            <source>Segment</source>
            <translation>Segment</translation>
        </message>
        <message>
            <source>Model</source>
            <translation>Modell</translation>
        </message>
        <message>
            <source>Retract</source>
            <translation>Retraktion</translation>
        </message>
        <message>
            <source>Compare</source>
            <translation>Vergleich</translation>
        </message>
        <message>
            <source>empty</source>
            <translation>leer</translation>
        </message>
        <message>
            <source>ready</source>
            <translation>bereit</translation>
        </message>
        <message>
            <source>running</source>
            <translation>rechnet</translation>
        </message>
        <message>
            <source>done</source>
            <translation>fertig</translation>
        </message>
        <message>
            <source>stale</source>
            <translation>veraltet</translation>
        </message>
        <message>
            <source>failed</source>
            <translation>Fehler</translation>
        </message>
    </context>
    <context>
        <name>glisson::session::ModelPreview</name>
        <message>
            <source>Building the model…</source>
            <translation>Das Modell wird gebaut…</translation>
        </message>
        <message>
            <source> %1 %</source>
            <translation> %1 %</translation>
        </message>
        <message>
            <source>Outline the liver first (step Segment): the model appears here.</source>
            <translation>Zuerst die Leber umranden (Schritt Segmentieren): hier erscheint das Modell.</translation>
        </message>
        <message>
            <source>Open a patient first: the model appears here.</source>
            <translation>Zuerst einen Patienten öffnen: hier erscheint das Modell.</translation>
        </message>
    </context>
    <context>
        <name>glisson::session::Session</name>
        <message>
            <source>Filming</source>
            <translation>Wird gefilmt</translation>
        </message>
        <message>
            <source>%1 and %2 more</source>
            <translation>%1 und %2 weitere</translation>
        </message>
        <message>
            <source>The synthetic patient</source>
            <translation>Der synthetische Patient</translation>
        </message>
        <message>
            <source>What was left behind</source>
            <translation>Das Zurückgelassene</translation>
        </message>
        <message>
            <source>There is no DICOM series, volume or case here; choose a DICOM folder, DICOMDIR, ZIP archive, a NIfTI, NRRD or MetaImage volume, or case.json.</source>
            <translation>Hier ist weder eine DICOM-Serie noch ein Volumen oder ein Fall; einen DICOM-Ordner, ein DICOMDIR, ein ZIP-Archiv, ein Volumen (NIfTI, NRRD, MetaImage) oder case.json wählen.</translation>
        </message>
        <message>
            <source>and %1 more files</source>
            <translation>und %1 weitere Dateien</translation>
        </message>
        <message>
            <source>a mask: its outlines are offered below</source>
            <translation>eine Maske: Ihre Konturen werden unten angeboten</translation>
        </message>
        <message>
            <source>a mask, and no image beside it: it is its own picture</source>
            <translation>eine Maske ohne Bild daneben: Sie ist ihr eigenes Bild</translation>
        </message>
        <message>
            <source>the file's name speaks of stiffness</source>
            <translation>der Dateiname spricht von Steifigkeit</translation>
        </message>
        <message>
            <source>a volume file, taken for an image</source>
            <translation>eine Volumendatei, für ein Bild gehalten</translation>
        </message>
        <message>
            <source>; beside DICOM series it is used where you give it a role</source>
            <translation>; neben DICOM-Serien wird sie verwendet, wenn Sie ihr eine Rolle geben</translation>
        </message>
        <message>
            <source>vertex</source>
            <translation>Punkt</translation>
        </message>
        <message>
            <source>Reading images</source>
            <translation>Bilder werden gelesen</translation>
        </message>
        <message>
            <source>Open a DICOM folder or the synthetic patient</source>
            <translation>DICOM-Ordner oder synthetischen Patienten öffnen</translation>
        </message>
        <message>
            <source>1 series</source>
            <translation>1 Serie</translation>
        </message>
        <message>
            <source>%1 series</source>
            <translation>%1 Serien</translation>
        </message>
        <message>
            <source>Needs images</source>
            <translation>Braucht Bilder</translation>
        </message>
        <message>
            <source>Outline the liver</source>
            <translation>Leber umfahren</translation>
        </message>
        <message>
            <source>1 outline</source>
            <translation>1 Kontur</translation>
        </message>
        <message>
            <source>%1 outlines</source>
            <translation>%1 Konturen</translation>
        </message>
        <message>
            <source>, %1 slices interpolated</source>
            <translation>, %1 Schichten interpoliert</translation>
        </message>
        <message>
            <source>, %1 slices between them empty</source>
            <translation>, %1 Schichten dazwischen leer</translation>
        </message>
        <message>
            <source>Needs an outline</source>
            <translation>Braucht eine Kontur</translation>
        </message>
        <message>
            <source>Running</source>
            <translation>Rechnet</translation>
        </message>
        <message>
            <source>Changed since the last run</source>
            <translation>Seit der letzten Rechnung geändert</translation>
        </message>
        <message>
            <source>Needs a run</source>
            <translation>Braucht eine Rechnung</translation>
        </message>
        <message>
            <source>Set and check</source>
            <translation>Einstellen und prüfen</translation>
        </message>
        <message>
            <source>Ready to run</source>
            <translation>Bereit</translation>
        </message>
        <message>
            <source>%1 cells</source>
            <translation>%1 Zellen</translation>
        </message>
        <message>
            <source>%1 DOFs</source>
            <translation>%1 Freiheitsgrade</translation>
        </message>
        <message>
            <source>Nothing was compared</source>
            <translation>Nichts wurde verglichen</translation>
        </message>
        <message>
            <source>mean %1 mm</source>
            <translation>Mittel %1 mm</translation>
        </message>
        <message>
            <source>No elastogram is open.</source>
            <translation>Kein Elastogramm ist geöffnet.</translation>
        </message>
        <message>
            <source>Draw an outline to measure.</source>
            <translation>Zum Messen eine Kontur zeichnen.</translation>
        </message>
        <message>
            <source>Cancelled.</source>
            <translation>Abgebrochen.</translation>
        </message>
        <message>
            <source>Opening</source>
            <translation>Wird geöffnet</translation>
        </message>
        <message>
            <source>Opening the synthetic patient</source>
            <translation>Der synthetische Patient wird geöffnet</translation>
        </message>
        <message>
            <source>Recovering</source>
            <translation>Wird zurückgeholt</translation>
        </message>
        <message>
            <source>Still at work; cancel it first.</source>
            <translation>Es wird noch gerechnet; zuerst abbrechen.</translation>
        </message>
        <message>
            <source>Outline the liver on two slices at least, and accept these outlines (Enter).</source>
            <translation>Die Leber auf mindestens zwei Schichten umranden und diese Konturen annehmen (Enter).</translation>
        </message>
        <message>
            <source>The outlines changed meanwhile; interpolate again.</source>
            <translation>Die Konturen haben sich inzwischen geändert; noch einmal interpolieren.</translation>
        </message>
        <message>
            <source>There is no empty slice between outlines that overlap.</source>
            <translation>Zwischen überlappenden Konturen gibt es keine leere Schicht.</translation>
        </message>
        <message>
            <source>%1 slices were interpolated between %2 drawn ones. They count; accept, correct or redraw them.</source>
            <translation>%1 Schichten wurden zwischen %2 gezeichneten interpoliert. Sie zählen; annehmen, verbessern oder neu zeichnen.</translation>
        </message>
        <message>
            <source>Interpolating</source>
            <translation>Wird interpoliert</translation>
        </message>
        <message>
            <source>The outlines changed meanwhile; propose again.</source>
            <translation>Die Konturen haben sich inzwischen geändert; noch einmal vorschlagen.</translation>
        </message>
        <message>
            <source>Proposed, but it reaches the border of the image: it may have leaked. Correct it.</source>
            <translation>Vorgeschlagen, aber der Vorschlag reicht bis zum Bildrand: er kann ausgelaufen sein. Bitte verbessern.</translation>
        </message>
        <message>
            <source>Proposed on every slice. Correct and accept; nothing is decided yet.</source>
            <translation>Auf jeder Schicht vorgeschlagen. Korrigieren und annehmen; noch ist nichts entschieden.</translation>
        </message>
        <message>
            <source>Proposing outlines</source>
            <translation>Konturen werden vorgeschlagen</translation>
        </message>
        <message>
            <source>Outline the liver and accept the outline (Enter) first.</source>
            <translation>Zuerst die Leber umfahren und die Kontur annehmen (Eingabe).</translation>
        </message>
        <message>
            <source>There is an outline on this slice: delete it before the slice is marked "no liver".</source>
            <translation>Auf dieser Schicht liegt eine Kontur: erst löschen, dann „keine Leber“ markieren.</translation>
        </message>
        <message>
            <source>This slice lies between outlined ones and is filled by shape; it cannot be without liver.</source>
            <translation>Diese Schicht liegt zwischen umrandeten und wird nach der Form gefüllt; sie kann nicht ohne Leber sein.</translation>
        </message>
        <message>
            <source>There is no outline on this slice to copy.</source>
            <translation>Auf dieser Schicht ist keine Kontur zum Kopieren.</translation>
        </message>
        <message>
            <source>Copied one outline.</source>
            <translation>Eine Kontur kopiert.</translation>
        </message>
        <message>
            <source>Copied %1 outlines.</source>
            <translation>%1 Konturen kopiert.</translation>
        </message>
        <message>
            <source>Copy an outline first (Ctrl+C).</source>
            <translation>Zuerst eine Kontur kopieren (Strg+C).</translation>
        </message>
        <message>
            <source>There is no empty slice there.</source>
            <translation>Dort ist keine leere Schicht.</translation>
        </message>
        <message>
            <source>Pasted on %1 slices. They count; accept, correct or redraw them.</source>
            <translation>Auf %1 Schichten eingefügt. Sie zählen; annehmen, korrigieren oder neu zeichnen.</translation>
        </message>
        <message>
            <source>Load a second reader's outlines first.</source>
            <translation>Zuerst die Konturen eines zweiten Befunders laden.</translation>
        </message>
        <message>
            <source>Dice %1, Jaccard %2
Hausdorff %3 mm (95 %: %4 mm), mean distance %5 mm
Volume %6 mL against %7 mL, difference %8 mL (%9 %)</source>
            <translation>Dice %1, Jaccard %2
Hausdorff %3 mm (95 %: %4 mm), mittlerer Abstand %5 mm
Volumen %6 mL gegen %7 mL, Unterschied %8 mL (%9 %)</translation>
        </message>
        <message>
            <source>Comparing readers</source>
            <translation>Befunder werden verglichen</translation>
        </message>
        <message>
            <source>The outlines have another frame of reference than this MRI: check that they lie where they did.</source>
            <translation>Die Konturen haben ein anderes Bezugssystem als dieses MRT: prüfen, ob sie noch da liegen, wo sie lagen.</translation>
        </message>
        <message>
            <source>Exporting</source>
            <translation>Exportieren</translation>
        </message>
        <message>
            <source>These outlines belong to another patient than the images that are open.</source>
            <translation>Diese Konturen gehören zu einem anderen Patienten als die offenen Bilder.</translation>
        </message>
        <message>
            <source>These outlines were drawn on images of another day than those that are open. Open these images, or choose outlines that were drawn on the open ones.</source>
            <translation>Diese Konturen wurden auf Bildern eines anderen Tages gezeichnet als den offenen. Diese Bilder öffnen oder Konturen wählen, die auf den offenen gezeichnet wurden.</translation>
        </message>
        <message>
            <source>These outlines have another frame of reference than the MRI: they may lie elsewhere in the patient.</source>
            <translation>Diese Konturen haben ein anderes Bezugssystem als das MRT: sie können woanders im Patienten liegen.</translation>
        </message>
        <message>
            <source>The elastogram is left out: series %1 is in colour, a picture of stiffness and not its values. Give the role to the grey-scale stiffness series.</source>
            <translation>Das Elastogramm bleibt weg: Serie %1 ist farbig, ein Bild der Steifigkeit und nicht ihre Werte. Die Rolle gehört der Steifigkeitsserie in Graustufen.</translation>
        </message>
        <message>
            <source>The MRI and the elastogram belong to different patients.</source>
            <translation>MRT und Elastogramm gehören zu verschiedenen Patienten.</translation>
        </message>
        <message>
            <source>The MRI and the elastogram were taken on different days.</source>
            <translation>MRT und Elastogramm wurden an verschiedenen Tagen aufgenommen.</translation>
        </message>
        <message>
            <source>The MRI and the elastogram have different frames of reference: the patient may have moved between them.</source>
            <translation>MRT und Elastogramm haben verschiedene Bezugssysteme: der Patient kann sich dazwischen bewegt haben.</translation>
        </message>
        <message>
            <source>Series %1 does not say what it holds, nor in which unit.</source>
            <translation>Serie %1 sagt nicht, was sie enthält, und nicht, in welcher Einheit.</translation>
        </message>
        <message>
            <source>no anatomical or magnitude MR series was found; give a series that role in the table</source>
            <translation>keine anatomische oder Magnituden-MR-Serie gefunden; in der Tabelle einer Serie diese Rolle geben</translation>
        </message>
        <message>
            <source>No stiffness series was found: outlines can be drawn, stiffness cannot be measured.</source>
            <translation>Keine Steifigkeitsserie gefunden: Konturen lassen sich zeichnen, Steifigkeit lässt sich nicht messen.</translation>
        </message>
        <message>
            <source>The elastogram holds Young's modulus; it is shown as shear modulus (Poisson's ratio %1).</source>
            <translation>Das Elastogramm enthält den Elastizitätsmodul; gezeigt wird der Schubmodul (Querkontraktionszahl %1).</translation>
        </message>
        <message>
            <source>No confidence map was found: every voxel with a stiffness counts.</source>
            <translation>Keine Konfidenzkarte gefunden: jedes Voxel mit einer Steifigkeit zählt.</translation>
        </message>
        <message>
            <source>cancelled</source>
            <translation>abgebrochen</translation>
        </message>
        <message>
            <source>Interpolated outlines accepted: %1.</source>
            <translation>Interpolierte Konturen angenommen: %1.</translation>
        </message>
        <message>
            <source>Undone: %1.</source>
            <translation>Rückgängig: %1.</translation>
        </message>
        <message>
            <source>Done again: %1.</source>
            <translation>Wiederholt: %1.</translation>
        </message>
        <message>
            <source>There is no DICOM series, volume or case here; choose a DICOM folder, DICOMDIR, ZIP archive or case.json.</source>
            <translation>Hier liegt weder eine DICOM-Serie noch ein Volumen noch ein Fall; einen DICOM-Ordner, DICOMDIR, ein ZIP-Archiv oder case.json wählen.</translation>
        </message>
        <message>
            <source>No answer: see How far to trust it</source>
            <translation>Keine Antwort: siehe Wie weit dem zu trauen ist</translation>
        </message>
        <message>
            <source>Drafts do not count (slices %1): accept or delete them before the numbers are used.</source>
            <translation>Entwürfe zählen nicht (Schichten %1): annehmen oder löschen, bevor die Zahlen verwendet werden.</translation>
        </message>
        <message>
            <source>Proposed on every slice. It counts already: correct and accept it.</source>
            <translation>Auf jeder Schicht vorgeschlagen. Es zählt schon: korrigieren und annehmen.</translation>
        </message>
    </context>
    <context>
        <name>glisson::views::SceneView</name>
        <message>
            <source>%1 mm</source>
            <translation>%1 mm</translation>
        </message>
        <message>
            <source>shear modulus µ (kPa)</source>
            <translation>Schubmodul µ (kPa)</translation>
        </message>
    </context>
    <context>
        <name>glisson::views::SliceView</name>
        <message>
            <source> kPa</source>
            <translation> kPa</translation>
        </message>
        <message>
            <source> mm</source>
            <translation> mm</translation>
        </message>
        <message>
            <source>slice %1 / %2</source>
            <translation>Schicht %1 / %2</translation>
        </message>
    </context>
    <context>
        <name>keymap</name>
        <message>
            <source>Alt+drag (or right drag: View, Mouse)</source>
            <translation>Alt+Ziehen (oder Ziehen mit rechts: Ansicht, Maus)</translation>
        </message>
        <message>
            <source>Stiffness over the MRI, on and off</source>
            <translation>Steifigkeit über der MRT, ein und aus</translation>
        </message>
        <message>
            <source>The view under the mouse alone, and back</source>
            <translation>Die Ansicht unter der Maus allein, und zurück</translation>
        </message>
        <message>
            <source>Three planes, linked by the crosshair</source>
            <translation>Drei Ebenen, durch das Fadenkreuz verbunden</translation>
        </message>
        <message>
            <source>Turn the 3-D view</source>
            <translation>3-D-Ansicht drehen</translation>
        </message>
        <message>
            <source>left drag</source>
            <translation>links ziehen</translation>
        </message>
        <message>
            <source>arrows</source>
            <translation>Pfeiltasten</translation>
        </message>
        <message>
            <source>Move the 3-D view</source>
            <translation>3-D-Ansicht verschieben</translation>
        </message>
        <message>
            <source>middle drag, Shift+left drag</source>
            <translation>Mitte ziehen, Umschalt+links ziehen</translation>
        </message>
        <message>
            <source>Shift+arrows</source>
            <translation>Umschalt+Pfeiltasten</translation>
        </message>
        <message>
            <source>Zoom</source>
            <translation>Vergrößern</translation>
        </message>
        <message>
            <source>wheel, right drag (picture: Ctrl+wheel)</source>
            <translation>Rad, rechts ziehen (Bild: Strg+Rad)</translation>
        </message>
        <message>
            <source>+ and -</source>
            <translation>+ und -</translation>
        </message>
        <message>
            <source>Show all</source>
            <translation>Alles zeigen</translation>
        </message>
        <message>
            <source>double-click</source>
            <translation>Doppelklick</translation>
        </message>
        <message>
            <source>Home</source>
            <translation>Pos1</translation>
        </message>
        <message>
            <source>Choose a handle or a vessel</source>
            <translation>Griff oder Gefäß wählen</translation>
        </message>
        <message>
            <source>click it</source>
            <translation>anklicken</translation>
        </message>
        <message>
            <source>Space: the next</source>
            <translation>Leertaste: der nächste</translation>
        </message>
        <message>
            <source>Move the chosen handle, or the live tool</source>
            <translation>Gewählten Griff oder das geführte Werkzeug bewegen</translation>
        </message>
        <message>
            <source>drag it</source>
            <translation>ziehen</translation>
        </message>
        <message>
            <source>Ctrl+arrows: 1 mm; with Shift: 10 mm</source>
            <translation>Strg+Pfeiltasten: 1 mm; mit Umschalt: 10 mm</translation>
        </message>
        <message>
            <source>Hold the liver, after &quot;Hold here…&quot;</source>
            <translation>Leber halten, nach „Hier halten…“</translation>
        </message>
        <message>
            <source>click on the liver</source>
            <translation>auf die Leber klicken</translation>
        </message>
        <message>
            <source>Enter: in the middle of the view</source>
            <translation>Eingabe: in der Mitte der Ansicht</translation>
        </message>
        <message>
            <source>Undo what was laid</source>
            <translation>Gelegtes zurücknehmen</translation>
        </message>
        <message>
            <source>Ctrl+Z</source>
            <translation>Strg+Z</translation>
        </message>
        <message>
            <source>Slice of a picture</source>
            <translation>Schicht eines Bildes</translation>
        </message>
        <message>
            <source>wheel</source>
            <translation>Rad</translation>
        </message>
        <message>
            <source>up and down</source>
            <translation>auf und ab</translation>
        </message>
        <message>
            <source>Tools</source>
            <translation>Werkzeuge</translation>
        </message>
        <message>
            <source>Outline</source>
            <translation>Kontur</translation>
        </message>
        <message>
            <source>Slices</source>
            <translation>Schichten</translation>
        </message>
        <message>
            <source>View</source>
            <translation>Ansicht</translation>
        </message>
        <message>
            <source>Polygon</source>
            <translation>Polygon</translation>
        </message>
        <message>
            <source>freehand</source>
            <translation>freihand</translation>
        </message>
        <message>
            <source>Freehand: letting go closes</source>
            <translation>Freihand: Loslassen schließt</translation>
        </message>
        <message>
            <source>Sculpt: push the outline with a disc</source>
            <translation>Formen: Kontur mit einer Scheibe schieben</translation>
        </message>
        <message>
            <source>Measure a distance</source>
            <translation>Abstand messen</translation>
        </message>
        <message>
            <source>Window and level by dragging</source>
            <translation>Fenster durch Ziehen</translation>
        </message>
        <message>
            <source>Close or accept</source>
            <translation>Schließen oder annehmen</translation>
        </message>
        <message>
            <source>Close and accept</source>
            <translation>Schließen und annehmen</translation>
        </message>
        <message>
            <source>Take the last vertex back; take a draft up again</source>
            <translation>Letzten Punkt zurücknehmen; Entwurf wieder aufnehmen</translation>
        </message>
        <message>
            <source>Delete the selected vertices or outline</source>
            <translation>Gewählte Punkte oder Kontur löschen</translation>
        </message>
        <message>
            <source>Split: halve the selected edges; two vertices apart: cut in two</source>
            <translation>Teilen: gewählte Kanten halbieren; zwei entfernte Punkte: durchschneiden</translation>
        </message>
        <message>
            <source>Trim: thin out the selection; two vertices apart: cut the smaller part off</source>
            <translation>Stutzen: Auswahl ausdünnen; zwei entfernte Punkte: kleineren Teil abschneiden</translation>
        </message>
        <message>
            <source>Park as draft; again: discard</source>
            <translation>Als Entwurf ablegen; nochmals: verwerfen</translation>
        </message>
        <message>
            <source>Undo</source>
            <translation>Rückgängig</translation>
        </message>
        <message>
            <source>Redo</source>
            <translation>Wiederherstellen</translation>
        </message>
        <message>
            <source>Select the whole outline</source>
            <translation>Ganze Kontur wählen</translation>
        </message>
        <message>
            <source>Select nothing</source>
            <translation>Nichts wählen</translation>
        </message>
        <message>
            <source>Copy the outline, or all of the slice</source>
            <translation>Kontur kopieren, oder alle der Schicht</translation>
        </message>
        <message>
            <source>Paste on this slice</source>
            <translation>Auf dieser Schicht einfügen</translation>
        </message>
        <message>
            <source>Paste on all empty slices between</source>
            <translation>Auf allen leeren Schichten dazwischen einfügen</translation>
        </message>
        <message>
            <source>First slice</source>
            <translation>Erste Schicht</translation>
        </message>
        <message>
            <source>Last slice</source>
            <translation>Letzte Schicht</translation>
        </message>
        <message>
            <source>Next slice</source>
            <translation>Nächste Schicht</translation>
        </message>
        <message>
            <source>Slice before</source>
            <translation>Vorige Schicht</translation>
        </message>
        <message>
            <source>Next slice that is still to be done</source>
            <translation>Nächste offene Schicht</translation>
        </message>
        <message>
            <source>Mark: no liver on this slice</source>
            <translation>Markieren: keine Leber auf dieser Schicht</translation>
        </message>
        <message>
            <source>Mark: no reliable wave on this slice</source>
            <translation>Markieren: keine verlässliche Welle</translation>
        </message>
        <message>
            <source>This outline counts</source>
            <translation>Diese Kontur zählt</translation>
        </message>
        <message>
            <source>This outline is left out (vessel, cyst)</source>
            <translation>Diese Kontur ist ausgenommen (Gefäß, Zyste)</translation>
        </message>
        <message>
            <source>Inner region: measure away from the edge</source>
            <translation>Innenbereich: abseits des Randes messen</translation>
        </message>
        <message>
            <source>Less erosion; with a disc in hand: smaller disc</source>
            <translation>Weniger Erosion; mit einer Scheibe in der Hand: kleinere Scheibe</translation>
        </message>
        <message>
            <source>More erosion; with a disc in hand: larger disc</source>
            <translation>Mehr Erosion; mit einer Scheibe in der Hand: größere Scheibe</translation>
        </message>
        <message>
            <source>Hold to hide all overlays</source>
            <translation>Gehalten: Überlagerungen verbergen</translation>
        </message>
        <message>
            <source>Window from the image</source>
            <translation>Fenster aus dem Bild</translation>
        </message>
        <message>
            <source>Window: soft (widest)</source>
            <translation>Fenster: weich (am breitesten)</translation>
        </message>
        <message>
            <source>Window: liver</source>
            <translation>Fenster: Leber</translation>
        </message>
        <message>
            <source>Window: vessels</source>
            <translation>Fenster: Gefäße</translation>
        </message>
        <message>
            <source>Window: bright</source>
            <translation>Fenster: hell</translation>
        </message>
        <message>
            <source>Window: dark</source>
            <translation>Fenster: dunkel</translation>
        </message>
        <message>
            <source>Link slice, zoom and place of the views</source>
            <translation>Schicht, Zoom und Ort der Ansichten koppeln</translation>
        </message>
        <message>
            <source>Stiffness scale 0–8 or 0–20 kPa</source>
            <translation>Steifigkeit 0–8 oder 0–20 kPa</translation>
        </message>
        <message>
            <source>Interpolate between outlined slices</source>
            <translation>Zwischen umfahrenen Schichten interpolieren</translation>
        </message>
        <message>
            <source>Accept all interpolated outlines</source>
            <translation>Alle interpolierten Konturen annehmen</translation>
        </message>
        <message>
            <source>Propose an outline: grow a region from under the mouse</source>
            <translation>Kontur vorschlagen: Bereich unter der Maus wachsen lassen</translation>
        </message>
        <message>
            <source>Compare with a second reader's outlines</source>
            <translation>Mit einem zweiten Befunder vergleichen</translation>
        </message>
        <message>
            <source>Play or stop the wave</source>
            <translation>Welle abspielen oder anhalten</translation>
        </message>
        <message>
            <source>This sheet</source>
            <translation>Diese Übersicht</translation>
        </message>
        <message>
            <source>Left click</source>
            <translation>Linksklick</translation>
        </message>
        <message>
            <source>first vertex</source>
            <translation>erster Punkt</translation>
        </message>
        <message>
            <source>Left drag</source>
            <translation>Links ziehen</translation>
        </message>
        <message>
            <source>Double-click</source>
            <translation>Doppelklick</translation>
        </message>
        <message>
            <source>accept; accepted: properties and statistics</source>
            <translation>annehmen; angenommen: Eigenschaften und Statistik</translation>
        </message>
        <message>
            <source>Right click</source>
            <translation>Rechtsklick</translation>
        </message>
        <message>
            <source>menu</source>
            <translation>Menü</translation>
        </message>
        <message>
            <source>close</source>
            <translation>schließen</translation>
        </message>
        <message>
            <source>Right drag, Ctrl+wheel</source>
            <translation>Rechts ziehen, Strg+Rad</translation>
        </message>
        <message>
            <source>zoom</source>
            <translation>Zoom</translation>
        </message>
        <message>
            <source>Middle drag, Space+drag</source>
            <translation>Mitte ziehen, Leertaste+Ziehen</translation>
        </message>
        <message>
            <source>pan</source>
            <translation>verschieben</translation>
        </message>
        <message>
            <source>Wheel</source>
            <translation>Rad</translation>
        </message>
        <message>
            <source>slice</source>
            <translation>Schicht</translation>
        </message>
        <message>
            <source>Alt+drag</source>
            <translation>Alt+Ziehen</translation>
        </message>
        <message>
            <source>window and level</source>
            <translation>Fenster</translation>
        </message>
        <message>
            <source>Ctrl+click</source>
            <translation>Strg+Klick</translation>
        </message>
        <message>
            <source>Nudge down by 0.1 pixel; nothing selected: slice before</source>
            <translation>0,1 Pixel nach unten; nichts gewählt: vorige Schicht</translation>
        </message>
        <message>
            <source>Nudge down by 1 pixel</source>
            <translation>1 Pixel nach unten</translation>
        </message>
        <message>
            <source>Nudge left by 0.1 pixel</source>
            <translation>0,1 Pixel nach links</translation>
        </message>
        <message>
            <source>Nudge left by 1 pixel</source>
            <translation>1 Pixel nach links</translation>
        </message>
        <message>
            <source>Nudge right by 0.1 pixel</source>
            <translation>0,1 Pixel nach rechts</translation>
        </message>
        <message>
            <source>Nudge right by 1 pixel</source>
            <translation>1 Pixel nach rechts</translation>
        </message>
        <message>
            <source>Nudge up by 0.1 pixel; nothing selected: next slice</source>
            <translation>0,1 Pixel nach oben; nichts gewählt: nächste Schicht</translation>
        </message>
        <message>
            <source>Nudge up by 1 pixel</source>
            <translation>1 Pixel nach oben</translation>
        </message>
        <message>
            <source>Shift+click</source>
            <translation>Umschalt+Klick</translation>
        </message>
        <message>
            <source>add last vertex and close</source>
            <translation>letzten Punkt setzen und schließen</translation>
        </message>
        <message>
            <source>add to or take from the selection</source>
            <translation>zur Auswahl dazu oder davon weg</translation>
        </message>
        <message>
            <source>add vertex; on the first one: close</source>
            <translation>Punkt setzen; auf dem ersten: schließen</translation>
        </message>
        <message>
            <source>freehand, mixes with clicks</source>
            <translation>Freihand, mit Klicks mischbar</translation>
        </message>
        <message>
            <source>inside an outline: start a hole</source>
            <translation>in einer Kontur: ein Loch beginnen</translation>
        </message>
        <message>
            <source>menu: delete, split, copy to slices, kind</source>
            <translation>Menü: löschen, teilen, auf Schichten kopieren, Art</translation>
        </message>
        <message>
            <source>move the selection; on empty: box select</source>
            <translation>Auswahl verschieben; im Leeren: Rahmen aufziehen</translation>
        </message>
        <message>
            <source>on an edge: insert a vertex; on a vertex: delete it</source>
            <translation>auf einer Kante: Punkt einfügen; auf einem Punkt: löschen</translation>
        </message>
        <message>
            <source>on an outline: properties and statistics</source>
            <translation>auf einer Kontur: Eigenschaften und Statistik</translation>
        </message>
        <message>
            <source>pan, the drawing is kept</source>
            <translation>verschieben, die Zeichnung bleibt</translation>
        </message>
        <message>
            <source>select vertex, edge or outline; on empty: clear</source>
            <translation>Punkt, Kante oder Kontur wählen; im Leeren: Auswahl aufheben</translation>
        </message>
        <message>
            <source>slice; the drawing is parked as a draft</source>
            <translation>Schicht; die Zeichnung wird als Entwurf abgelegt</translation>
        </message>
        <message>
            <source>steps of 45°</source>
            <translation>Schritte von 45°</translation>
        </message>
        <message>
            <source>window and level, the drawing is kept</source>
            <translation>Fensterung, die Zeichnung bleibt</translation>
        </message>
        <message>
            <source>zoom, the drawing is kept</source>
            <translation>Zoom, die Zeichnung bleibt</translation>
        </message>
        <message>
            <source>Click at the crosshair: vertex, close on the first one, select</source>
            <translation>Klick am Fadenkreuz: Punkt setzen, auf dem ersten schließen, auswählen</translation>
        </message>
        <message>
            <source>Crosshair left by 1 pixel</source>
            <translation>Fadenkreuz 1 Pixel nach links</translation>
        </message>
        <message>
            <source>Crosshair left by 10 pixels</source>
            <translation>Fadenkreuz 10 Pixel nach links</translation>
        </message>
        <message>
            <source>Crosshair right by 1 pixel</source>
            <translation>Fadenkreuz 1 Pixel nach rechts</translation>
        </message>
        <message>
            <source>Crosshair right by 10 pixels</source>
            <translation>Fadenkreuz 10 Pixel nach rechts</translation>
        </message>
        <message>
            <source>Crosshair up by 1 pixel</source>
            <translation>Fadenkreuz 1 Pixel nach oben</translation>
        </message>
        <message>
            <source>Crosshair up by 10 pixels</source>
            <translation>Fadenkreuz 10 Pixel nach oben</translation>
        </message>
        <message>
            <source>Crosshair down by 1 pixel</source>
            <translation>Fadenkreuz 1 Pixel nach unten</translation>
        </message>
        <message>
            <source>Crosshair down by 10 pixels</source>
            <translation>Fadenkreuz 10 Pixel nach unten</translation>
        </message>
        <message>
            <source>Ellipse: drag from corner to corner; with Shift a circle</source>
            <translation>Ellipse: von Ecke zu Ecke ziehen; mit Umschalt ein Kreis</translation>
        </message>
        <message>
            <source>Brush that keeps to the edges of the image; with Shift the whole disc</source>
            <translation>Pinsel, der sich an die Kanten des Bildes hält; mit Umschalt die ganze Scheibe</translation>
        </message>
        <message>
            <source>Eraser that keeps to the edges of the image; with Shift the whole disc</source>
            <translation>Radierer, der sich an die Kanten des Bildes hält; mit Umschalt die ganze Scheibe</translation>
        </message>
        <message>
            <source>Livewire: clicks joined along the edges of the image</source>
            <translation>Livewire: Klicks, entlang der Kanten des Bildes verbunden</translation>
        </message>
        <message>
            <source>Spline: a smooth outline through the clicks</source>
            <translation>Spline: eine glatte Kontur durch die Klicks</translation>
        </message>
        <message>
            <source>Unite: join the selected outline with those it meets</source>
            <translation>Vereinigen: die gewählte Kontur mit denen, die sie trifft</translation>
        </message>
        <message>
            <source>Take out: cut the selected outline out of those it meets</source>
            <translation>Abziehen: die gewählte Kontur von denen, die sie trifft</translation>
        </message>
        <message>
            <source>In common: keep what the selected outline shares with those it meets</source>
            <translation>Schnittmenge: behalten, was die gewählte Kontur mit denen teilt, die sie trifft</translation>
        </message>
    </context>
    <context>
        <name>commands</name>
        <message>
            <source>accept all interpolated outlines</source>
            <translation>alle interpolierten Konturen annehmen</translation>
        </message>
        <message>
            <source>accept outline</source>
            <translation>Kontur annehmen</translation>
        </message>
        <message>
            <source>add draft outline</source>
            <translation>Entwurf hinzufügen</translation>
        </message>
        <message>
            <source>add outline</source>
            <translation>Kontur hinzufügen</translation>
        </message>
        <message>
            <source>cut outline</source>
            <translation>Kontur schneiden</translation>
        </message>
        <message>
            <source>delete outline</source>
            <translation>Kontur löschen</translation>
        </message>
        <message>
            <source>delete vertices</source>
            <translation>Punkte löschen</translation>
        </message>
        <message>
            <source>exclude outline</source>
            <translation>Kontur auslassen</translation>
        </message>
        <message>
            <source>import outlines</source>
            <translation>Konturen einlesen</translation>
        </message>
        <message>
            <source>include outline</source>
            <translation>Kontur zählen</translation>
        </message>
        <message>
            <source>insert vertex</source>
            <translation>Punkt einfügen</translation>
        </message>
        <message>
            <source>interpolate between slices</source>
            <translation>zwischen Schichten interpolieren</translation>
        </message>
        <message>
            <source>make outline a draft</source>
            <translation>Kontur zum Entwurf machen</translation>
        </message>
        <message>
            <source>mark slice</source>
            <translation>Schicht markieren</translation>
        </message>
        <message>
            <source>move vertices</source>
            <translation>Punkte verschieben</translation>
        </message>
        <message>
            <source>nudge</source>
            <translation>verrücken</translation>
        </message>
        <message>
            <source>paste on empty slices</source>
            <translation>auf leere Schichten einfügen</translation>
        </message>
        <message>
            <source>paste outline</source>
            <translation>Kontur einfügen</translation>
        </message>
        <message>
            <source>propose outlines</source>
            <translation>Konturen vorschlagen</translation>
        </message>
        <message>
            <source>rename region</source>
            <translation>Region umbenennen</translation>
        </message>
        <message>
            <source>sculpt</source>
            <translation>formen</translation>
        </message>
        <message>
            <source>unmark slice</source>
            <translation>Markierung aufheben</translation>
        </message>
        <message>
            <source>brush</source>
            <translation>malen</translation>
        </message>
        <message>
            <source>erase</source>
            <translation>radieren</translation>
        </message>
        <message>
            <source>unite outlines</source>
            <translation>Konturen vereinigen</translation>
        </message>
        <message>
            <source>take outline out</source>
            <translation>Kontur abziehen</translation>
        </message>
        <message>
            <source>keep common part</source>
            <translation>Schnittmenge behalten</translation>
        </message>
    </context>
    <context>
        <name>tools</name>
        <message>
            <source>Closed. Drag vertices to adjust, Enter to accept.</source>
            <translation>Geschlossen. Punkte ziehen zum Anpassen, Eingabe nimmt an.</translation>
        </message>
        <message>
            <source>The outline crosses itself. Move a vertex, or press Enter to accept it all the same.</source>
            <translation>Die Kontur kreuzt sich selbst. Einen Punkt verschieben, oder mit Eingabe trotzdem annehmen.</translation>
        </message>
        <message>
            <source>The outline crosses itself. Press Enter again to accept it all the same.</source>
            <translation>Die Kontur kreuzt sich selbst. Nochmals Eingabe nimmt sie trotzdem an.</translation>
        </message>
        <message>
            <source>The outline crosses itself now and is a draft again. Move a vertex, or press Enter to accept it all the same.</source>
            <translation>Die Kontur kreuzt sich jetzt selbst und ist wieder ein Entwurf. Einen Punkt verschieben, oder mit Eingabe trotzdem annehmen.</translation>
        </message>
        <message>
            <source>A region needs three different vertices, this outline has %1.</source>
            <translation>Ein Bereich braucht drei verschiedene Punkte, diese Kontur hat %1.</translation>
        </message>
        <message>
            <source>A region needs at least %1 voxels, this outline holds %2. Draw it larger.</source>
            <translation>Ein Bereich braucht mindestens %1 Voxel, diese Kontur enthält %2. Größer zeichnen.</translation>
        </message>
        <message>
            <source>Not changed: a region needs three different vertices, this outline would have %1.</source>
            <translation>Nicht geändert: Ein Bereich braucht drei verschiedene Punkte, diese Kontur hätte %1.</translation>
        </message>
        <message>
            <source>Not changed: a region needs at least %1 voxels, this outline would hold %2.</source>
            <translation>Nicht geändert: Ein Bereich braucht mindestens %1 Voxel, diese Kontur enthielte %2.</translation>
        </message>
        <message>
            <source>%1</source>
            <translation>%1</translation>
        </message>
        <message>
            <source>Parked as a draft. Backspace takes it up again, Esc discards it.</source>
            <translation>Als Entwurf abgelegt. Rücktaste nimmt ihn wieder auf, Esc verwirft ihn.</translation>
        </message>
        <message>
            <source>Parked as a draft on slice %1. Click it there: Backspace takes it up again, Esc discards it.</source>
            <translation>Als Entwurf auf Schicht %1 abgelegt. Dort anklicken: Rücktaste nimmt ihn wieder auf, Esc verwirft ihn.</translation>
        </message>
        <message>
            <source>Draft discarded; undo brings it back.</source>
            <translation>Entwurf verworfen; Rückgängig holt ihn zurück.</translation>
        </message>
        <message>
            <source>Fewer than three vertices would be left: the whole outline is deleted.</source>
            <translation>Es blieben weniger als drei Punkte: Die ganze Kontur wird gelöscht.</translation>
        </message>
        <message>
            <source>An outline inside a region becomes a hole.</source>
            <translation>Eine Kontur in einem Bereich wird ein Loch.</translation>
        </message>
        <message>
            <source>Once accepted, this outline replaces the interpolated ones of the slice.</source>
            <translation>Sobald angenommen, ersetzt diese Kontur die interpolierten der Schicht.</translation>
        </message>
        <message>
            <source>There is no outline on this slice to sculpt.</source>
            <translation>Auf dieser Schicht gibt es keine Kontur zum Formen.</translation>
        </message>
        <message>
            <source>Select an outline first: click its edge.</source>
            <translation>Zuerst eine Kontur auswählen: ihren Rand anklicken.</translation>
        </message>
        <message>
            <source>Cut in two.</source>
            <translation>In zwei geteilt.</translation>
        </message>
        <message>
            <source>Split needs an edge (two neighbours) or two vertices apart.</source>
            <translation>Teilen braucht eine Kante (zwei Nachbarn) oder zwei Punkte, die auseinanderliegen.</translation>
        </message>
        <message>
            <source>Trim needs more vertices: at least three stay.</source>
            <translation>Stutzen braucht mehr Punkte: Mindestens drei bleiben.</translation>
        </message>
        <message>
            <source>This outline is left out of the region.</source>
            <translation>Diese Kontur wird aus dem Bereich ausgelassen.</translation>
        </message>
        <message>
            <source>This outline counts.</source>
            <translation>Diese Kontur zählt.</translation>
        </message>
        <message>
            <source>Accepted.</source>
            <translation>Angenommen.</translation>
        </message>
        <message>
            <source>Painted. Paint on, or press Enter to accept.</source>
            <translation>Gemalt. Weitermalen, oder Eingabe nimmt an.</translation>
        </message>
        <message>
            <source>There is no outline under the eraser.</source>
            <translation>Unter dem Radierer liegt keine Kontur.</translation>
        </message>
        <message>
            <source>The whole outline is erased; undo brings it back.</source>
            <translation>Die ganze Kontur ist wegradiert; Rückgängig bringt sie zurück.</translation>
        </message>
        <message>
            <source>Parts and holes of fewer than %1 voxels were left out: %2.</source>
            <translation>Teile und Löcher mit weniger als %1 Voxeln wurden ausgelassen: %2.</translation>
        </message>
        <message>
            <source>The selected outline meets no other one of its kind on this slice.</source>
            <translation>Die gewählte Kontur trifft auf dieser Schicht keine andere ihrer Art.</translation>
        </message>
        <message>
            <source>Nothing to do: the outlines mean that already.</source>
            <translation>Nichts zu tun: die Konturen bedeuten das bereits.</translation>
        </message>
        <message>
            <source>Not changed: no outline would be left.</source>
            <translation>Nicht geändert: es bliebe keine Kontur übrig.</translation>
        </message>
        <message>
            <source>The outlines are one region now.</source>
            <translation>Die Konturen sind jetzt ein Bereich.</translation>
        </message>
        <message>
            <source>The selected outline is taken out of those it met.</source>
            <translation>Die gewählte Kontur ist von denen abgezogen, die sie traf.</translation>
        </message>
        <message>
            <source>What the outlines had in common is left.</source>
            <translation>Geblieben ist, was die Konturen gemeinsam hatten.</translation>
        </message>
    </context>
    <context>
        <name>glisson::session::Worker</name>
        <message>
            <source>, %1 s left</source>
            <translation>, noch %1 s</translation>
        </message>
        <message>
            <source>, %1 min left</source>
            <translation>, noch %1 min</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::ContactTable</name>
        <message>
            <source>slips</source>
            <translation>rutscht ab</translation>
        </message>
        <message>
            <source>past its largest force</source>
            <translation>jenseits der Höchstkraft</translation>
        </message>
        <message>
            <source>folds the liver</source>
            <translation>faltet die Leber</translation>
        </message>
        <message>
            <source>cuts into the liver</source>
            <translation>schneidet in die Leber</translation>
        </message>
        <message>
            <source>no answer</source>
            <translation>keine Lösung</translation>
        </message>
        <message>
            <source>bears</source>
            <translation>trägt</translation>
        </message>
        <message>
            <source>not met</source>
            <translation>nicht erreicht</translation>
        </message>
        <message>
            <source>corotational</source>
            <translation>korotationell</translation>
        </message>
        <message>
            <source>hyperelastic</source>
            <translation>hyperelastisch</translation>
        </message>
        <message>
            <source>linear</source>
            <translation>linear</translation>
        </message>
        <message>
            <source>Contact of bar and liver</source>
            <translation>Kontakt von Bügel und Leber</translation>
        </message>
        <message>
            <source>Bar</source>
            <translation>Bügel</translation>
        </message>
        <message>
            <source>MRE</source>
            <translation>MRE</translation>
        </message>
        <message>
            <source>Atlas</source>
            <translation>Atlas</translation>
        </message>
        <message>
            <source>Travel</source>
            <translation>Weg</translation>
        </message>
        <message>
            <source>Area</source>
            <translation>Fläche</translation>
        </message>
        <message>
            <source>Pressure</source>
            <translation>Druck</translation>
        </message>
        <message>
            <source>Capacity</source>
            <translation>Tragkraft</translation>
        </message>
        <message>
            <source>Place</source>
            <translation>Stelle</translation>
        </message>
        <message>
            <source>The bar is a spread patch here: a pressure on %1 cm² at rest.</source>
            <translation>Der Bügel ist hier ein verteilter Druck auf %1 cm² in Ruhe.</translation>
        </message>
        <message>
            <source>Kinematics: %1 (%2).</source>
            <translation>Kinematik: %1 (%2).</translation>
        </message>
        <message>
            <source>With the atlas stiffness the bar travels %1 mm further.</source>
            <translation>Mit der Atlas-Steifigkeit geht der Bügel %1 mm weiter.</translation>
        </message>
        <message>
            <source>With the measured stiffness the bar travels %1 mm further.</source>
            <translation>Mit der gemessenen Steifigkeit geht der Bügel %1 mm weiter.</translation>
        </message>
        <message>
            <source>Hoist</source>
            <translation>Zug</translation>
        </message>
        <message>
            <source>Resultant</source>
            <translation>Resultierende</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::RetractorForm</name>
        <message>
            <source>A rigid bar is offered for voxel FEM only: choose it on the Model page.</source>
            <translation>Einen starren Bügel gibt es nur für Voxel-FEM: auf der Seite Modell wählen.</translation>
        </message>
        <message>
            <source>A rigid bar is offered at rest only: leave out the time steps on the Model page.</source>
            <translation>Einen starren Bügel gibt es nur in Ruhe: auf der Seite Modell die Zeitschritte weglassen.</translation>
        </message>
        <message>
            <source>A condensed response has no rigid bar: choose another solver on the Model page.</source>
            <translation>Eine kondensierte Antwort hat keinen starren Bügel: auf der Seite Modell einen anderen Löser wählen.</translation>
        </message>
        <message>
            <source>A rigid bar is offered for automatic, hyperelastic or linear deformation: choose one on the Model page.</source>
            <translation>Einen starren Bügel gibt es für automatische, hyperelastische oder lineare Verformung: auf der Seite Modell eine wählen.</translation>
        </message>
        <message>
            <source>Nathanson retractor</source>
            <translation>Nathanson-Retraktor</translation>
        </message>
        <message>
            <source>The same for MRE and atlas.</source>
            <translation>Gleich für MRE und Atlas.</translation>
        </message>
        <message>
            <source>Liver and abdomen</source>
            <translation>Leber und Bauch</translation>
        </message>
        <message>
            <source>Rigid bar</source>
            <translation>Starrer Bügel</translation>
        </message>
        <message>
            <source>Spread patch (as published)</source>
            <translation>Verteilter Druck (wie veröffentlicht)</translation>
        </message>
        <message>
            <source>Contact</source>
            <translation>Kontakt</translation>
        </message>
        <message>
            <source>Straight</source>
            <translation>Gerade</translation>
        </message>
        <message>
            <source>Hook</source>
            <translation>Haken</translation>
        </message>
        <message>
            <source>Shape</source>
            <translation>Form</translation>
        </message>
        <message>
            <source>Diameter of the bar</source>
            <translation>Durchmesser des Bügels</translation>
        </message>
        <message>
            <source>Diameter</source>
            <translation>Durchmesser</translation>
        </message>
        <message>
            <source>Length of the bar that bears</source>
            <translation>Tragende Länge des Bügels</translation>
        </message>
        <message>
            <source>Length</source>
            <translation>Länge</translation>
        </message>
        <message>
            <source>Wrap</source>
            <translation>Umschlingung</translation>
        </message>
        <message>
            <source>The liver&apos;s weight</source>
            <translation>Gewicht der Leber</translation>
        </message>
        <message>
            <source>Given force</source>
            <translation>Gegebene Kraft</translation>
        </message>
        <message>
            <source>Given travel</source>
            <translation>Gegebener Weg</translation>
        </message>
        <message>
            <source>Hoist</source>
            <translation>Zug</translation>
        </message>
        <message>
            <source>Force</source>
            <translation>Kraft</translation>
        </message>
        <message>
            <source>Travel</source>
            <translation>Weg</translation>
        </message>
        <message>
            <source>Glisson&apos;s capsule</source>
            <translation>Glisson-Kapsel</translation>
        </message>
        <message>
            <source>Its stiffness</source>
            <translation>Ihre Steifigkeit</translation>
        </message>
        <message>
            <source>Elastic resistance per area of the posterior and superior surface (Winkler foundation)</source>
            <translation>Elastischer Widerstand je Fläche der hinteren und oberen Oberfläche (Winkler-Bettung)</translation>
        </message>
        <message>
            <source>Resistance</source>
            <translation>Widerstand</translation>
        </message>
        <message>
            <source>A spread patch has none: choose the rigid bar.</source>
            <translation>Ein verteilter Druck (patch) hat das nicht: den starren Bügel wählen.</translation>
        </message>
        <message>
            <source>Rigid bar: a body of its own that pushes and does not pull, without friction, in large deformation. Spread patch: a pressure on the liver at rest, as in the published study.</source>
            <translation>Starrer Bügel: ein eigener Körper, der drückt und nicht zieht, ohne Reibung, in großer Verformung. Verteilter Druck: ein Druck auf die Leber in Ruhe, wie in der veröffentlichten Studie.</translation>
        </message>
        <message>
            <source>Hook: the same length bent to a quarter turn, as the blade of a Nathanson retractor</source>
            <translation>Haken: dieselbe Länge, zu einer Vierteldrehung gebogen, wie das Blatt eines Nathanson-Retraktors</translation>
        </message>
        <message>
            <source>Tissue wraps round the bar: how far its pressure reaches beyond it; 0 is a bare bar</source>
            <translation>Gewebe legt sich um den Bügel: wie weit sein Druck über ihn hinausreicht; 0 ist ein blanker Bügel</translation>
        </message>
        <message>
            <source>A rigid bar touches where it touches: only a spread patch has a wrap.</source>
            <translation>Ein starrer Bügel berührt, wo er berührt: eine Umschlingung hat nur der verteilte Druck.</translation>
        </message>
        <message>
            <source>What both livers are given: a force, or the bar&apos;s way from its first touch</source>
            <translation>Was beiden Lebern gegeben wird: eine Kraft, oder der Weg des Bügels von seiner ersten Berührung an</translation>
        </message>
        <message>
            <source>Hoisting force, towards anterior in the transverse plane</source>
            <translation>Zugkraft nach vorn in der Transversalebene</translation>
        </message>
        <message>
            <source>Choose &quot;Given force&quot; to set it.</source>
            <translation>Zum Einstellen „Gegebene Kraft“ wählen.</translation>
        </message>
        <message>
            <source>Way of the bar from its first touch, along the hoist</source>
            <translation>Weg des Bügels von seiner ersten Berührung an, längs des Zugs</translation>
        </message>
        <message>
            <source>Choose &quot;Given travel&quot; to set it.</source>
            <translation>Zum Einstellen „Gegebener Weg“ wählen.</translation>
        </message>
        <message>
            <source>Stiff skin of the liver, which carries tension along its surface</source>
            <translation>Steife Haut der Leber, die Zug längs ihrer Oberfläche trägt</translation>
        </message>
        <message>
            <source>Young&apos;s modulus of the capsule times its thickness</source>
            <translation>Elastizitätsmodul der Kapsel mal ihre Dicke</translation>
        </message>
        <message>
            <source>The capsule is left out.</source>
            <translation>Die Kapsel ist weggelassen.</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::PlaneViews</name>
        <message>
            <source>This plane is being made.</source>
            <translation>Diese Ebene wird gemacht.</translation>
        </message>
        <message>
            <source>Axial</source>
            <translation>Axial</translation>
        </message>
        <message>
            <source>Coronal</source>
            <translation>Koronal</translation>
        </message>
        <message>
            <source>Sagittal</source>
            <translation>Sagittal</translation>
        </message>
        <message>
            <source>Open images first (step Load).</source>
            <translation>Zuerst Bilder öffnen (Schritt Laden).</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::RegionList</name>
        <message>
            <source>structure</source>
            <translation>Struktur</translation>
        </message>
        <message>
            <source>segment</source>
            <translation>Segment</translation>
        </message>
        <message>
            <source>contours</source>
            <translation>Konturen</translation>
        </message>
        <message>
            <source>mask</source>
            <translation>Maske</translation>
        </message>
        <message>
            <source>mask, label %1</source>
            <translation>Maske, Label %1</translation>
        </message>
        <message>
            <source>Outlines and masks beside the images</source>
            <translation>Konturen und Masken neben den Bildern</translation>
        </message>
        <message>
            <source>Region</source>
            <translation>Region</translation>
        </message>
        <message>
            <source>Kind</source>
            <translation>Art</translation>
        </message>
        <message>
            <source>File</source>
            <translation>Datei</translation>
        </message>
        <message>
            <source>unnamed</source>
            <translation>ohne Namen</translation>
        </message>
        <message>
            <source>Take as outlines</source>
            <translation>Als Konturen nehmen</translation>
        </message>
        <message>
            <source>Takes %1 of %2 as outlines</source>
            <translation>Nimmt %1 aus %2 als Konturen</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::SeriesTree</name>
        <message>
            <source>anatomical</source>
            <translation>anatomisch</translation>
        </message>
        <message>
            <source>magnitude</source>
            <translation>Magnitude</translation>
        </message>
        <message>
            <source>wave</source>
            <translation>Welle</translation>
        </message>
        <message>
            <source>stiffness</source>
            <translation>Steifigkeit</translation>
        </message>
        <message>
            <source>confidence</source>
            <translation>Konfidenz</translation>
        </message>
        <message>
            <source>colour copy</source>
            <translation>Farbkopie</translation>
        </message>
        <message>
            <source>raw phase</source>
            <translation>rohe Phase</translation>
        </message>
        <message>
            <source>other</source>
            <translation>andere</translation>
        </message>
        <message>
            <source>Volume files, of no named patient</source>
            <translation>Volumendateien, ohne Patientenangabe</translation>
        </message>
        <message>
            <source>Patient %1</source>
            <translation>Patient %1</translation>
        </message>
        <message>
            <source>without a date</source>
            <translation>ohne Datum</translation>
        </message>
        <message>
            <source>Files, %1</source>
            <translation>Dateien, %1</translation>
        </message>
        <message>
            <source>%1 examination, %2</source>
            <translation>%1-Untersuchung, %2</translation>
        </message>
        <message>
            <source>Patients, studies and series</source>
            <translation>Patienten, Untersuchungen und Serien</translation>
        </message>
        <message>
            <source>Series</source>
            <translation>Serie</translation>
        </message>
        <message>
            <source>In use</source>
            <translation>Im Gebrauch</translation>
        </message>
        <message>
            <source>Role</source>
            <translation>Rolle</translation>
        </message>
        <message>
            <source>Why</source>
            <translation>Warum</translation>
        </message>
        <message>
            <source>Voxels</source>
            <translation>Voxel</translation>
        </message>
        <message>
            <source>Spacing</source>
            <translation>Abstand</translation>
        </message>
        <message>
            <source>Warnings</source>
            <translation>Warnungen</translation>
        </message>
        <message>
            <source>In use: the MRI that is drawn on</source>
            <translation>Im Gebrauch: die MRT, auf der gezeichnet wird</translation>
        </message>
        <message>
            <source>In use: the elastogram that is measured</source>
            <translation>Im Gebrauch: das Elastogramm, das gemessen wird</translation>
        </message>
        <message>
            <source>Use this one</source>
            <translation>Diese verwenden</translation>
        </message>
        <message>
            <source>Role of series %1</source>
            <translation>Rolle der Serie %1</translation>
        </message>
    </context>
    <context>
        <name>diagnostics</name>
        <message>
            <source>the multigrid solver {reason} after {spent} iterations; {solver} took over with {iterations} iterations: the answer is as exact, and took longer than it should have</source>
            <translation>der Mehrgitterlöser {reason} nach {spent} Iterationen; {solver} hat mit {iterations} Iterationen übernommen: Die Antwort ist ebenso genau, hat aber länger gebraucht als nötig</translation>
        </message>
        <message>
            <source>the largest displacement ({displacement_mm} mm) exceeds the body ({body_mm} mm): not a deformation</source>
            <translation>die größte Verschiebung ({displacement_mm} mm) übersteigt den Körper ({body_mm} mm): Das ist keine Verformung</translation>
        </message>
        <message>
            <source>cells turned inside out: {cells}</source>
            <translation>umgestülpte Zellen: {cells}</translation>
        </message>
        <message>
            <source>outside linear elasticity: 5 % of the volume strains by more than {percent} % (limit {limit_percent} %)</source>
            <translation>außerhalb der linearen Elastizität: 5 % des Volumens dehnen sich um mehr als {percent} % (Grenze {limit_percent} %)</translation>
        </message>
        <message>
            <source>outside linear elasticity: material turns by up to {degrees} degrees (limit {limit_degrees})</source>
            <translation>außerhalb der linearen Elastizität: Das Gewebe dreht sich um bis zu {degrees} Grad (Grenze {limit_degrees})</translation>
        </message>
        <message>
            <source>material turns by up to {degrees} degrees: small-strain theory adds a spurious strain of about 1 % from 8 degrees on</source>
            <translation>das Gewebe dreht sich um bis zu {degrees} Grad: Die Theorie kleiner Dehnungen täuscht ab 8 Grad etwa 1 % Dehnung vor</translation>
        </message>
        <message>
            <source>{percent} % of the volume strains by more than 10 %</source>
            <translation>{percent} % des Volumens dehnen sich um mehr als 10 %</translation>
        </message>
        <message>
            <source>the NIfTI header places the volume twice, up to {mm} mm apart (turned by {degrees} degrees, {handedness}): its sform was taken; other programs take the qform, so save it again with one place</source>
            <translation>der NIfTI-Kopf gibt dem Volumen zwei Lagen, bis zu {mm} mm auseinander (um {degrees} Grad gedreht, {handedness}): Seine sform wurde genommen; andere Programme nehmen die qform, darum mit einer einzigen Lage neu speichern</translation>
        </message>
        <message>
            <source>the NIfTI header gives voxels of {pixdim_mm} mm and, by its sform, of {sform_mm} mm: those of the sform were taken</source>
            <translation>der NIfTI-Kopf gibt Voxel von {pixdim_mm} mm an und nach seiner sform von {sform_mm} mm: Die der sform wurden genommen</translation>
        </message>
        <message>
            <source>the volume's header does not say where it lies in the patient (no {missing}): it was laid along the patient's axes from the centre of the scanner; save it with its place</source>
            <translation>der Kopf des Volumens sagt nicht, wo im Patienten es liegt (keine Angabe: {missing}): Es wurde von der Mitte des Geräts aus längs der Achsen des Patienten gelegt; mit seiner Lage speichern</translation>
        </message>
        <message>
            <source>the volume's header calls its axes {said} (AnatomicalOrientation), but its directions are {taken}, which were taken: one of the two is wrong</source>
            <translation>der Kopf des Volumens nennt seine Achsen {said} (AnatomicalOrientation), seine Richtungen sind aber {taken}, und diese wurden genommen: Eines von beiden ist falsch</translation>
        </message>
        <message>
            <source>the volume's voxels are {smallest_mm} to {largest_mm} mm large by its header, which those of no image of a patient are: check the unit of its lengths</source>
            <translation>die Voxel des Volumens sind nach seinem Kopf {smallest_mm} bis {largest_mm} mm groß, wie in keinem Bild eines Patienten: die Einheit der Längen prüfen</translation>
        </message>
        <message>
            <source>the mask of what is to be left out holds no voxel of the region of interest: nothing was left out; check that both belong together</source>
            <translation>die Maske des Auszulassenden enthält kein Voxel der Region: Nichts wurde ausgelassen; prüfen, ob beide zusammengehören</translation>
        </message>
        <message>
            <source>{there} of {announced} images are there, by the number of images in its acquisition that its header gives: was the transfer complete?</source>
            <translation>{there} von {announced} Bildern sind da, nach der Zahl der Bilder der Aufnahme, die ihr Kopf angibt: War die Übertragung vollständig?</translation>
        </message>
        <message>
            <source>{there} of {announced} slices are there, by the number of slices that its header gives: was the transfer complete?</source>
            <translation>{there} von {announced} Schichten sind da, nach der Zahl der Schichten, die ihr Kopf angibt: War die Übertragung vollständig?</translation>
        </message>
        <message>
            <source>its slices lie up to {mm} mm off an even spacing of {spacing_mm} mm, as rounded positions do; the even spacing was taken</source>
            <translation>ihre Schichten liegen bis zu {mm} mm neben einem gleichmäßigen Abstand von {spacing_mm} mm, wie bei gerundeten Lagen; der gleichmäßige Abstand wurde genommen</translation>
        </message>
        <message>
            <source>its {slices} slices lie unevenly ({smallest_mm} to {largest_mm} mm apart): statistics count each slice by itself, and no volume can be made of them</source>
            <translation>ihre {slices} Schichten liegen ungleichmäßig ({smallest_mm} bis {largest_mm} mm auseinander): Die Statistik zählt jede Schicht für sich, ein Volumen lässt sich daraus nicht machen</translation>
        </message>
        <message>
            <source>no image series was found; {files} files were left out</source>
            <translation>es wurde keine Bildserie gefunden; {files} Dateien wurden ausgelassen</translation>
        </message>
        <message>
            <source>volume {volume} of {volumes} in one series, told apart by {told}</source>
            <translation>Volumen {volume} von {volumes} in einer Serie, unterschieden durch {told}</translation>
        </message>
        <message>
            <source>has a real-world value map that differs from its rescale; the {used} is used, which {because}: confirm which is meant</source>
            <translation>hat eine Wertetabelle (real-world value map), die von ihrer Skalierung abweicht; verwendet wird: {used}, denn dies {because}: bestätigen, was gemeint ist</translation>
        </message>
        <message>
            <source>has a real-world value map that gives neither a slope nor a table, and was not used: confirm the unit with --unit</source>
            <translation>hat eine Wertetabelle (real-world value map) ohne Steigung und ohne Tabelle, sie wurde nicht verwendet: die Einheit bestätigen</translation>
        </message>
        <message>
            <source>has a private scale factor ({factor}) that differs from its rescale and names no unit: the rescale is used; confirm which is meant</source>
            <translation>hat einen eigenen Skalenfaktor ({factor}), der von ihrer Skalierung abweicht und keine Einheit nennt: Die Skalierung wird verwendet; bestätigen, was gemeint ist</translation>
        </message>
        <message>
            <source>its slices are in different units ({units}); all were turned into {unit}</source>
            <translation>ihre Schichten haben verschiedene Einheiten ({units}); alle wurden in {unit} umgerechnet</translation>
        </message>
        <message>
            <source>this scanner writes its stiffness in {usual}; the files say {unit}, which is taken</source>
            <translation>dieses Gerät schreibt seine Steifigkeit in {usual}; die Dateien sagen {unit}, und das wird genommen</translation>
        </message>
        <message>
            <source>this scanner writes its stiffness in {usual}; the description says {unit}, which is taken: confirm it with --unit</source>
            <translation>dieses Gerät schreibt seine Steifigkeit in {usual}; die Beschreibung sagt {unit}, und das wird genommen: bestätigen</translation>
        </message>
        <message>
            <source>is called a map in {words}, but its values are said to be in {unit}, which is taken: confirm it</source>
            <translation>heißt eine Karte in {words}, ihre Werte sollen aber in {unit} sein, und das wird genommen: bestätigen</translation>
        </message>
        <message>
            <source>was taken as {role} by {by}, but {against} says {other}: check its role</source>
            <translation>wurde nach {by} als {role} genommen, aber {against} sagt {other}: die Rolle prüfen</translation>
        </message>
        <message>
            <source>{voxels} voxels of the map are marked as padding and hold no value</source>
            <translation>{voxels} Voxel der Karte sind als Füllung gekennzeichnet und haben keinen Wert</translation>
        </message>
        <message>
            <source>{voxels} voxels of the map lie outside of the stored values that its real-world value map is defined for, and hold no value</source>
            <translation>{voxels} Voxel der Karte liegen außerhalb der gespeicherten Werte, für die ihre Wertetabelle gilt, und haben keinen Wert</translation>
        </message>
        <message>
            <source>{with} of its {slices} slices say which stored values are padding, the others do not: of those every value counts; check their edges</source>
            <translation>{with} von {slices} Schichten sagen, welche gespeicherten Werte Füllung sind, die anderen nicht: Bei diesen zählt jeder Wert; ihre Ränder prüfen</translation>
        </message>
        <message>
            <source>several elastography acquisitions are here: the {role} of series {series} goes with the stiffness of series {stiffness} ({tie})</source>
            <translation>mehrere Elastographie-Aufnahmen sind hier: {role} der Serie {series} gehört zur Steifigkeit der Serie {stiffness} ({tie})</translation>
        </message>
        <message>
            <source>the {role} of series {series} was taken with the stiffness of series {stiffness} only because of the order of their series numbers: check that they belong together</source>
            <translation>{role} der Serie {series} wurde nur wegen der Reihenfolge der Seriennummern zur Steifigkeit der Serie {stiffness} genommen: prüfen, ob sie zusammengehören</translation>
        </message>
        <message>
            <source>the {role} of series {series} belongs to another acquisition than the stiffness of series {stiffness} ({tie}) and was not used; give it by hand with --role {series}={role} if it belongs to it</source>
            <translation>{role} der Serie {series} gehört zu einer anderen Aufnahme als die Steifigkeit der Serie {stiffness} ({tie}) und wurde nicht verwendet; gehört sie doch dazu, ihr die Rolle {role} von Hand geben (Serie {series})</translation>
        </message>
        <message>
            <source>several {role} series ({all}) fit the stiffness of series {stiffness} equally well: none was used; choose one by hand with --role</source>
            <translation>mehrere Serien der Rolle {role} ({all}) passen gleich gut zur Steifigkeit der Serie {stiffness}: Keine wurde verwendet; eine von Hand wählen</translation>
        </message>
        <message>
            <source>the {role} of series {series} was taken with the stiffness of series {stiffness} ({tie}), but by {against} it would be that of series {other}: check which belongs to it</source>
            <translation>{role} der Serie {series} wurde zur Steifigkeit der Serie {stiffness} genommen ({tie}), nach {against} gehörte sie aber zu Serie {other}: prüfen, wozu sie gehört</translation>
        </message>
        <message>
            <source>the {role} of series {series} and the stiffness of series {stiffness} differ in {what}: check that they belong together</source>
            <translation>{role} der Serie {series} und die Steifigkeit der Serie {stiffness} unterscheiden sich in {what}: prüfen, ob sie zusammengehören</translation>
        </message>
        <message>
            <source>the {role} of series {series} has {there} slices, the stiffness of series {stiffness} has {here}: was the transfer of the stiffness complete?</source>
            <translation>{role} der Serie {series} hat {there} Schichten, die Steifigkeit der Serie {stiffness} hat {here}: War die Übertragung der Steifigkeit vollständig?</translation>
        </message>
        <message>
            <source>{count} outlines repeat another one of their slice ({slices} slices): each counts once</source>
            <translation>{count} Konturen wiederholen eine andere ihrer Schicht ({slices} Schichten): Jede zählt einmal</translation>
        </message>
        <message>
            <source>{count} outlines overlap another one of their slice ({slices} slices): what they enclose together is the region; delete one if only one is meant</source>
            <translation>{count} Konturen überlappen eine andere ihrer Schicht ({slices} Schichten): Was sie zusammen einschließen, ist die Region; eine löschen, wenn nur eine gemeint ist</translation>
        </message>
        <message>
            <source>{count} outlines lie up to {mm} mm above or below the others of their slice: they were taken as parts of it</source>
            <translation>{count} Konturen liegen bis zu {mm} mm über oder unter den anderen ihrer Schicht: Sie wurden als Teile davon genommen</translation>
        </message>
        <message>
            <source>{count} outlines were left out: another one that overlaps them lies nearer to the middle of their slice (up to {mm} mm apart)</source>
            <translation>{count} Konturen wurden ausgelassen: Eine andere, die sie überlappt, liegt näher an der Mitte ihrer Schicht (bis zu {mm} mm auseinander)</translation>
        </message>
        <message>
            <source>{count} of {all} outlines lie on none of the image's slices and do not count</source>
            <translation>{count} von {all} Konturen liegen auf keiner Schicht des Bildes und zählen nicht</translation>
        </message>
        <message>
            <source>on {slices} slices the outlines leave nothing: each takes away what another one encloses</source>
            <translation>auf {slices} Schichten lassen die Konturen nichts übrig: Jede nimmt weg, was eine andere einschließt</translation>
        </message>
        <message>
            <source>on {slices} slices an outline inside another one leaves less than half of what that one encloses; it was taken as a hole: delete one of the two if the region was drawn twice</source>
            <translation>auf {slices} Schichten lässt eine Kontur innerhalb einer anderen weniger als die Hälfte von deren Fläche übrig; sie wurde als Loch genommen: eine von beiden löschen, wenn die Region zweimal gezeichnet wurde</translation>
        </message>
        <message>
            <source>{count} outlines are smaller than a quarter of a pixel</source>
            <translation>{count} Konturen sind kleiner als ein Viertel eines Pixels</translation>
        </message>
        <message>
            <source>{count} outlines cross themselves or run twice round a place ({slices} slices): check what they enclose</source>
            <translation>{count} Konturen kreuzen sich selbst oder laufen zweimal um eine Stelle ({slices} Schichten): prüfen, was sie einschließen</translation>
        </message>
        <message>
            <source>{missing} of {slices} elastography slices from the first to the last outlined one hold no outline and were left out; give the image that the outlines were drawn on (--mri) to have them interpolated</source>
            <translation>{missing} von {slices} Elastographie-Schichten von der ersten bis zur letzten umrissenen haben keine Kontur und wurden ausgelassen; das Bild angeben, auf dem gezeichnet wurde, damit sie interpoliert werden</translation>
        </message>
        <message>
            <source>a proposal to be corrected by hand, not a result</source>
            <translation>ein Vorschlag, von Hand zu berichtigen, kein Ergebnis</translation>
        </message>
        <message>
            <source>the proposal touches the border of the image: cut off, or leaked</source>
            <translation>der Vorschlag berührt den Rand des Bildes: abgeschnitten oder ausgelaufen</translation>
        </message>
        <message>
            <source>{count} of {shells} closed shells of the surface repeat another one: each counts once</source>
            <translation>{count} von {shells} geschlossenen Schalen der Oberfläche wiederholen eine andere: Jede zählt einmal</translation>
        </message>
        <message>
            <source>{count} of {shells} closed shells of the surface cross another one: what they enclose together is the body</source>
            <translation>{count} von {shells} geschlossenen Schalen der Oberfläche kreuzen eine andere: Was sie zusammen einschließen, ist der Körper</translation>
        </message>
        <message>
            <source>{count} of {shells} closed shells of the surface lie inside another one and are turned outwards like it: they were taken as cavities; delete them if they are none</source>
            <translation>{count} von {shells} geschlossenen Schalen der Oberfläche liegen in einer anderen und sind wie diese nach außen gewendet: Sie wurden als Hohlräume genommen; löschen, wenn sie keine sind</translation>
        </message>
        <message>
            <source>{count} of {shells} closed shells of the surface are too small to hold a cell's centre</source>
            <translation>{count} von {shells} geschlossenen Schalen der Oberfläche sind zu klein für den Mittelpunkt einer Zelle</translation>
        </message>
        <message>
            <source>the surface encloses {mL} mL and is {longest_mm} mm long if its coordinates are millimetres, which no liver is: check their unit</source>
            <translation>die Oberfläche umschließt {mL} mL und ist {longest_mm} mm lang, wenn ihre Koordinaten Millimeter sind, wie bei keiner Leber: ihre Einheit prüfen</translation>
        </message>
        <message>
            <source>there is no confidence map: every voxel of the region of interest counts</source>
            <translation>es gibt keine Konfidenzkarte: Jedes Voxel der Region zählt</translation>
        </message>
        <message>
            <source>the confidence of series {series} was not used: its slices do not lie where the elastogram's do, which lie unevenly</source>
            <translation>die Konfidenz der Serie {series} wurde nicht verwendet: Ihre Schichten liegen nicht dort, wo die ungleichmäßigen des Elastogramms liegen</translation>
        </message>
        <message>
            <source>the largest value of the confidence map is {largest}: {scale} was taken as full confidence; say which stored value means full confidence (--confidence-scale) if it is another</source>
            <translation>der größte Wert der Konfidenzkarte ist {largest}: {scale} wurde als volle Konfidenz genommen; angeben, wenn es ein anderer ist</translation>
        </message>
        <message>
            <source>the confidence map covers {percent} % of the elastogram (slices without any: {slices}); voxels without a confidence do not count</source>
            <translation>die Konfidenzkarte deckt {percent} % des Elastogramms (Schichten ohne: {slices}); Voxel ohne Konfidenz zählen nicht</translation>
        </message>
        <message>
            <source>{voxels} of {of} voxels of the region of interest have no confidence value and do not count</source>
            <translation>{voxels} von {of} Voxeln der Region haben keinen Konfidenzwert und zählen nicht</translation>
        </message>
        <message>
            <source>{voxels} of {of} voxels of the region of interest, less than a hundredth, hold no stiffness and do not count</source>
            <translation>{voxels} von {of} Voxeln der Region, weniger als ein Hundertstel, haben keine Steifigkeit und zählen nicht</translation>
        </message>
        <message>
            <source>the stiffness of slices {slices} is another order of magnitude than the median of all, {median_kPa} kPa: are they in another unit?</source>
            <translation>die Steifigkeit der Schichten {slices} hat eine andere Größenordnung als der Median aller, {median_kPa} kPa: Sind sie in einer anderen Einheit?</translation>
        </message>
        <message>
            <source>{voxels} of {of} voxels hold one and the same value, {kPa} kPa, far above the others: the ceiling of the map, or padding that nothing marks; leave them out with --exclude or --confidence if so</source>
            <translation>{voxels} von {of} Voxeln haben ein und denselben Wert, {kPa} kPa, weit über den anderen: die Obergrenze der Karte oder ungekennzeichnete Füllung; wenn ja, auslassen</translation>
        </message>
        <message>
            <source>words of the series, not a code, say that it holds {quantity}, which is taken: confirm it with --quantity</source>
            <translation>Worte der Serie, kein Code, sagen, dass sie {quantity} enthält, und das wird genommen: bestätigen</translation>
        </message>
        <message>
            <source>the series says by its code that it holds {quantity} and by its description {other}; the code is taken: confirm it with --quantity</source>
            <translation>die Serie sagt mit ihrem Code, dass sie {quantity} enthält, und mit ihrer Beschreibung {other}; der Code wird genommen: bestätigen</translation>
        </message>
        <message>
            <source>the series says that it holds {quantity}; it was taken as {asked}, as asked for</source>
            <translation>die Serie sagt, dass sie {quantity} enthält; sie wurde wie verlangt als {asked} genommen</translation>
        </message>
        <message>
            <source>the map holds the speed of shear waves; it was turned into the shear modulus with a density of {density_kg_m3} kg/m3</source>
            <translation>die Karte enthält die Geschwindigkeit der Scherwellen; sie wurde mit einer Dichte von {density_kg_m3} kg/m³ in den Schermodul umgerechnet</translation>
        </message>
        <message>
            <source>of several series, series {series} was taken as the {what}: the outline was drawn on it</source>
            <translation>von mehreren Serien wurde Serie {series} als {what} genommen: Auf ihr wurde die Kontur gezeichnet</translation>
        </message>
        <message>
            <source>the outline was drawn on series {named}, but series {taken} was taken as the {what}: check that they lie in one place</source>
            <translation>die Kontur wurde auf Serie {named} gezeichnet, aber Serie {taken} wurde als {what} genommen: prüfen, ob sie am selben Ort liegen</translation>
        </message>
        <message>
            <source>the outline names a series that it was drawn on, which is not here; series {taken} was taken as the {what}</source>
            <translation>die Kontur nennt eine Serie, auf der sie gezeichnet wurde und die nicht hier ist; Serie {taken} wurde als {what} genommen</translation>
        </message>
        <message>
            <source>the outline says that it was drawn on series {named}, but its images are those of series {series}, which is believed</source>
            <translation>die Kontur sagt, sie sei auf Serie {named} gezeichnet, ihre Bilder sind aber die der Serie {series}, und das wird geglaubt</translation>
        </message>
        <message>
            <source>{count} of {of} {what} do not lie on the image that they name, but up to {distance_mm} mm from it; they count where their coordinates are: one of the two is wrong</source>
            <translation>{count} von {of} {what} liegen nicht auf dem Bild, das sie nennen, sondern bis zu {distance_mm} mm davon; sie zählen dort, wo ihre Koordinaten sind: Eines von beiden ist falsch</translation>
        </message>
        <message>
            <source>the region of interest does not say in which frame of reference it lies: check that it is the {image}'s</source>
            <translation>die Region sagt nicht, in welchem Bezugssystem sie liegt: prüfen, ob es das von {image} ist</translation>
        </message>
        <message>
            <source>{count} structures of this name have no contours; number {number}, the only one with contours, was taken</source>
            <translation>{count} Strukturen dieses Namens haben keine Konturen; Nummer {number}, die einzige mit Konturen, wurde genommen</translation>
        </message>
        <message>
            <source>{kind} number {number} was taken as the region because it is the only one {that}, but its name says more than that: check that it is the organ itself, or choose one with --name</source>
            <translation>{kind} Nummer {number} wurde als Region genommen, weil sie die einzige ist ({that}), ihr Name sagt aber mehr: prüfen, ob es das Organ selbst ist, oder eine andere wählen</translation>
        </message>
        <message>
            <source>--name was not used: it chooses a structure or segment of a DICOM file, and the region of interest is {what}</source>
            <translation>der Name wurde nicht verwendet: Er wählt eine Struktur oder ein Segment einer DICOM-Datei, die Region ist aber {what}</translation>
        </message>
        <message>
            <source>the bar slips at {capacity_N} N after {capacity_travel_mm} mm ({stiffness} stiffness): {asked} cannot be reached at this place; choose a place where the body is thicker and level across the bar, or ask for less</source>
            <translation>der Retraktor rutscht bei {capacity_N} N nach {capacity_travel_mm} mm ab (Steifigkeit: {stiffness}): {asked} wird an dieser Stelle nicht erreicht; eine Stelle wählen, wo die Leber dicker und quer zum Stab eben ist, oder weniger verlangen</translation>
        </message>
        <message>
            <source>the surface beside the bar folds and cells turn inside out ({stiffness} stiffness): {capacity_N} N is borne, and {asked} is not reached; choose a smaller force or travel, a thicker bar, or other cells</source>
            <translation>die Oberfläche neben dem Stab faltet sich und Zellen stülpen sich um (Steifigkeit: {stiffness}): {capacity_N} N werden getragen, {asked} wird nicht erreicht; weniger Kraft oder Weg, einen dickeren Stab oder andere Zellen wählen</translation>
        </message>
        <message>
            <source>the bar bore {capacity_N} N after {capacity_travel_mm} mm, then less, before it bears {force_N} N after {travel_mm} mm ({stiffness} stiffness): under a force it moves on by itself between the two</source>
            <translation>der Stab trug {capacity_N} N nach {capacity_travel_mm} mm, dann weniger, bevor er {force_N} N nach {travel_mm} mm trägt (Steifigkeit: {stiffness}): Unter einer Kraft gleitet er dazwischen von selbst weiter</translation>
        </message>
        <message>
            <source>{percent} % of the body is compressed to less than half of its volume ({stiffness} stiffness), far beyond what was measured of any soft tissue: places there are not to be trusted</source>
            <translation>{percent} % des Körpers sind auf weniger als die Hälfte ihres Volumens zusammengedrückt (Steifigkeit: {stiffness}), weit über das hinaus, was an Weichgewebe gemessen wurde: Orten dort ist nicht zu trauen</translation>
        </message>
        <message>
            <source>cells of {cell_mm} mm may be off by {error_mm} mm in a displacement of {displacement_mm} mm {where}: use smaller cells before these numbers are used</source>
            <translation>Zellen von {cell_mm} mm können bei einer Verschiebung von {displacement_mm} mm um {error_mm} mm danebenliegen ({where}): kleinere Zellen nehmen, bevor diese Zahlen verwendet werden</translation>
        </message>
        <message>
            <source>the bar cuts into the surface ({stiffness} stiffness): after {capacity_travel_mm} mm and {capacity_N} N it has drawn the cells there apart, and {asked} is not reached; choose a smaller force or travel, a thicker bar, or smaller cells</source>
            <translation>der Stab schneidet in die Oberfläche (Steifigkeit: {stiffness}): Nach {capacity_travel_mm} mm und {capacity_N} N hat er dort die Zellen auseinandergezogen, {asked} wird nicht erreicht; weniger Kraft oder Weg, einen dickeren Stab oder kleinere Zellen wählen</translation>
        </message>
        <message>
            <source>the bar bears {force_N} N at this travel ({stiffness} stiffness), and bore {capacity_N} N on its way: under a force instead of a travel it would have moved on by itself</source>
            <translation>der Stab trägt {force_N} N bei diesem Weg (Steifigkeit: {stiffness}) und trug unterwegs {capacity_N} N: Unter einer Kraft statt eines Weges wäre er von selbst weitergerutscht</translation>
        </message>
        <message>
            <source>the bar first touches the body {distance_mm} mm {side} the place given, along its hoist: it was moved there, and its travel counts from there</source>
            <translation>der Stab berührt den Körper zuerst {distance_mm} mm {side} der angegebenen Stelle, längs seines Zuges: Er wurde dorthin gelegt, und sein Weg zählt von dort</translation>
        </message>
        <message>
            <source>no equilibrium was found under the loads ({stiffness} stiffness, residual {residual} of {tolerance}); they are too large for this body, or nothing holds it: choose smaller loads or further supports</source>
            <translation>unter den Lasten wurde kein Gleichgewicht gefunden (Steifigkeit: {stiffness}, Residuum {residual} von {tolerance}); sie sind für diesen Körper zu groß, oder nichts hält ihn: kleinere Lasten oder weitere Halterungen wählen</translation>
        </message>
        <message>
            <source>the bar folds the surface: a cell there is turned inside out, and places within a cell of it are not to be trusted</source>
            <translation>der Stab faltet die Oberfläche: Eine Zelle dort ist umgestülpt, Stellen im Umkreis einer Zelle ist nicht zu trauen</translation>
        </message>
        <message>
            <source>outside corotational theory, whose strains are small: 5 % of the volume strains by more than {percent} % (limit {limit_percent} %); use hyperelastic kinematics</source>
            <translation>außerhalb der korotationalen Theorie, deren Dehnungen klein sind: 5 % des Volumens dehnen sich um mehr als {percent} % (Grenze {limit_percent} %); hyperelastische Kinematik verwenden</translation>
        </message>
        <message>
            <source>the solve did not converge ({stiffness} stiffness): {status}; these numbers are not the answer</source>
            <translation>die Lösung ist nicht konvergiert (Steifigkeit: {stiffness}): {status}; diese Zahlen sind nicht die Antwort</translation>
        </message>
        <message>
            <source>mesh-free model: {limit}</source>
            <translation>netzfreies Modell: {limit}</translation>
        </message>
        <message>
            <source>{count} of {of} probes lie outside the body and have no displacement (by their place in the list, from 0: {probes})</source>
            <translation>{count} von {of} Messpunkten liegen außerhalb des Körpers und haben keine Verschiebung (nach ihrer Stelle in der Liste, ab 0: {probes})</translation>
        </message>
        <message>
            <source>the retractor is a patch of pressure here, not a rigid bar, which is not offered for {what}; "contact": "patch" says that this is meant</source>
            <translation>der Retraktor ist hier eine Druckfläche, kein starrer Stab, der für {what} nicht angeboten wird; "contact": "patch" sagt, dass dies gemeint ist</translation>
        </message>
        <message>
            <source>"{key}" is not used in this scene: {why}</source>
            <translation>"{key}" wird in dieser Szene nicht verwendet: {why}</translation>
        </message>
        <message>
            <source>area and largest pressure of the contact depend on the size of the cells ({cell_mm} mm here): compare them between runs with cells of one size only; the force does not depend on them</source>
            <translation>Fläche und größter Druck des Kontakts hängen von der Größe der Zellen ab (hier {cell_mm} mm): nur zwischen Rechnungen mit gleich großen Zellen vergleichen; die Kraft hängt nicht von ihnen ab</translation>
        </message>
        <message>
            <source>hyperelastic kinematics use mean-dilatation hexahedra, whatever element the scene names</source>
            <translation>hyperelastische Kinematik verwendet Hexaeder mit mittlerer Dilatation, welches Element die Szene auch nennt</translation>
        </message>
        <message>
            <source>Poisson's ratio is {poisson}: a body that widens where it is stretched; soft tissue has .45 to .499</source>
            <translation>die Querkontraktionszahl ist {poisson}: ein Körper, der breiter wird, wo er gedehnt wird; Weichgewebe hat 0.45 bis 0.499</translation>
        </message>
        <message>
            <source>{what} is {value} {unit}, far from what {usually}: check the number and its unit</source>
            <translation>{what} ist {value} {unit}, weit entfernt von dem, was {usually}: Zahl und Einheit prüfen</translation>
        </message>
        <message>
            <source>the scene asks for Glisson's capsule, which acts together with a rigid bar only, and there is none ({instead}): it was left out; ask for "contact": "rigid", or leave "capsule" out</source>
            <translation>die Szene verlangt die Glisson-Kapsel, die nur zusammen mit einem starren Stab wirkt, und einen solchen gibt es nicht ({instead}): Sie wurde ausgelassen; "contact": "rigid" verlangen oder "capsule" weglassen</translation>
        </message>
        <message>
            <source>the {name} ligament was taken as two sheets of peritoneum with the tension of the capsule: {stiffness_N_per_mm} N/mm over a width of {width_mm} mm and a length of {length_mm} mm; give "stiffness_N_per_mm" where it is known</source>
            <translation>das Band {name} wurde als zwei Blätter Bauchfell mit der Spannung der Kapsel genommen: {stiffness_N_per_mm} N/mm über {width_mm} mm Breite und {length_mm} mm Länge; "stiffness_N_per_mm" angeben, wenn bekannt</translation>
        </message>
        <message>
            <source>the rigid bar in contact is not part of this export: its force acts as a pressure spread over the surface at rest instead, in linear theory</source>
            <translation>der starre Stab im Kontakt gehört nicht zu diesem Export: Seine Kraft wirkt stattdessen als Druck, über die ruhende Oberfläche verteilt, in linearer Theorie</translation>
        </message>
        <message>
            <source>{count} of the scene's supports ({what}) are not part of this export as they are: ligaments are left out, springs that only press pull as well</source>
            <translation>{count} der Halterungen der Szene ({what}) gehören nicht so zu diesem Export, wie sie sind: Bänder werden ausgelassen, Federn, die nur drücken, ziehen auch</translation>
        </message>
        <message>
            <source>{count} loads that follow their faces keep direction and size in this export</source>
            <translation>{count} Lasten, die ihren Flächen folgen, behalten in diesem Export Richtung und Größe</translation>
        </message>
        <message>
            <source>none of {places} places on the lower right lobe bears the force; the best bears {percent} % of it: this liver does not suit a retraction by a bar of this kind, or needs a smaller force</source>
            <translation>keine von {places} Stellen am unteren rechten Lappen trägt die Kraft; die beste trägt {percent} % davon: Diese Leber eignet sich nicht für eine Retraktion mit einem solchen Stab, oder die Kraft muss kleiner sein</translation>
        </message>
        <message>
            <source>the body is not stable in the linear answer: under this load it may buckle or snap through, and move far more than linear theory says; {instead}, or choose a smaller load</source>
            <translation>der Körper ist in der linearen Antwort nicht stabil: Unter dieser Last kann er knicken oder durchschlagen und sich viel weiter bewegen, als die lineare Theorie sagt; {instead}, oder eine kleinere Last wählen</translation>
        </message>
        <message>
            <source>linear theory misses up to {missed_mm} mm {where} (it is trusted below {limit_mm} mm); where that matters, {instead}</source>
            <translation>die lineare Theorie verfehlt bis zu {missed_mm} mm {where} (unter {limit_mm} mm wird ihr getraut); wo das zählt, {instead}</translation>
        </message>
        <message>
            <source>the motion had not come to rest after {seconds} s; raise "end_s", or the damping, where the state at rest is wanted</source>
            <translation>die Bewegung war nach {seconds} s nicht zur Ruhe gekommen; "end_s" oder die Dämpfung erhöhen, wenn der Ruhezustand gewünscht ist</translation>
        </message>
        <message>
            <source>the time step was shortened from {asked_ms} to {taken_ms} ms, so that {steps} steps end at {end_s} s</source>
            <translation>der Zeitschritt wurde von {asked_ms} auf {taken_ms} ms verkürzt, damit {steps} Schritte bei {end_s} s enden</translation>
        </message>
        <message>
            <source>the condensed motion misses about {error_mm} mm of the full model's at most (estimated at five moments); use another solver where that is too much</source>
            <translation>die kondensierte Bewegung verfehlt die des vollen Modells um höchstens etwa {error_mm} mm (an fünf Zeitpunkten geschätzt); einen anderen Löser verwenden, wenn das zu viel ist</translation>
        </message>
        <message>
            <source>no difference is given: the run with the {stiffness} stiffness is no answer ({reason})</source>
            <translation>es wird kein Unterschied angegeben: Die Rechnung mit der Steifigkeit {stiffness} ist keine Antwort ({reason})</translation>
        </message>
        <message>
            <source>the difference at the retractor, {at_retractor_mm} mm, is no further from {line_mm} mm than the cells may shift it ({error_mm} mm): use smaller cells before saying on which side of that line it lies</source>
            <translation>der Unterschied am Retraktor, {at_retractor_mm} mm, ist von {line_mm} mm nicht weiter entfernt, als ihn die Zellen verschieben können ({error_mm} mm): kleinere Zellen verwenden, bevor gesagt wird, auf welcher Seite dieser Grenze er liegt</translation>
        </message>
        <message>
            <source>the scene asks how sure the answer is, which is offered for a rigid bar on voxel hexahedra at rest only ({instead}): no uncertainty is given</source>
            <translation>die Szene fragt, wie sicher die Antwort ist, was nur für einen starren Stab auf ruhenden Voxel-Hexaedern angeboten wird ({instead}): Es wird keine Unsicherheit angegeben</translation>
        </message>
        <message>
            <source>how sure the answer is cannot be told: the equilibrium with the {stiffness} stiffness is at the edge of what the place bears, where the smallest change may make the bar slip or the body snap; choose a place that bears more, or a smaller force</source>
            <translation>wie sicher die Antwort ist, lässt sich nicht sagen: Das Gleichgewicht mit der Steifigkeit {stiffness} liegt am Rand dessen, was die Stelle trägt, wo die kleinste Änderung den Stab rutschen oder den Körper durchschlagen lassen kann; eine tragfähigere Stelle oder eine kleinere Kraft wählen</translation>
        </message>
        <message>
            <source>full solves of {draws} draws of all sources are {percent} % off what the first order says of them: the intervals were widened by that much, and are rough</source>
            <translation>volle Lösungen von {draws} Ziehungen aller Quellen weichen {percent} % von dem ab, was die erste Ordnung über sie sagt: Die Intervalle wurden um so viel erweitert und sind grob</translation>
        </message>
        <message>
            <source>{lost} of {draws} draws of all sources have no equilibrium near this one: within what is known of this patient the bar may slip or the body snap, which the intervals do not contain</source>
            <translation>{lost} von {draws} Ziehungen aller Quellen haben kein Gleichgewicht in der Nähe von diesem: Nach dem, was von diesem Patienten bekannt ist, kann der Stab rutschen oder der Körper durchschlagen, was die Intervalle nicht enthalten</translation>
        </message>
    </context>
    <context>
        <name>steps</name>
        <message>
            <source>reading the MRI</source>
            <translation>MRT wird gelesen</translation>
        </message>
        <message>
            <source>reading the elastogram</source>
            <translation>Elastogramm wird gelesen</translation>
        </message>
        <message>
            <source>reading the stiffness map</source>
            <translation>Steifigkeitskarte wird gelesen</translation>
        </message>
        <message>
            <source>reading the outlines</source>
            <translation>Konturen werden gelesen</translation>
        </message>
        <message>
            <source>measuring the stiffness</source>
            <translation>Steifigkeit wird gemessen</translation>
        </message>
        <message>
            <source>making the cells</source>
            <translation>Zellen werden gemacht</translation>
        </message>
        <message>
            <source>finding a place for the bar</source>
            <translation>Stelle für den Stab wird gesucht</translation>
        </message>
        <message>
            <source>finding the vessels</source>
            <translation>Gefäße werden gesucht</translation>
        </message>
        <message>
            <source>placing mesh-free frames</source>
            <translation>netzfreie Rahmen werden gesetzt</translation>
        </message>
        <message>
            <source>assembling the stiffness matrix</source>
            <translation>Steifigkeitsmatrix wird aufgestellt</translation>
        </message>
        <message>
            <source>assembling the mass matrix</source>
            <translation>Massenmatrix wird aufgestellt</translation>
        </message>
        <message>
            <source>damping</source>
            <translation>Dämpfung</translation>
        </message>
        <message>
            <source>time steps</source>
            <translation>Zeitschritte</translation>
        </message>
        <message>
            <source>condensing the response</source>
            <translation>Antwort wird kondensiert</translation>
        </message>
        <message>
            <source>large deformation</source>
            <translation>große Verformung</translation>
        </message>
        <message>
            <source>Glisson's capsule</source>
            <translation>Glisson-Kapsel</translation>
        </message>
        <message>
            <source>ligaments</source>
            <translation>Bänder</translation>
        </message>
        <message>
            <source>loads that follow the surface</source>
            <translation>Lasten, die der Oberfläche folgen</translation>
        </message>
        <message>
            <source>solving with the measured stiffness</source>
            <translation>Lösen mit gemessener Steifigkeit</translation>
        </message>
        <message>
            <source>solving with the atlas stiffness</source>
            <translation>Lösen mit Atlas-Steifigkeit</translation>
        </message>
        <message>
            <source>solving in linear theory</source>
            <translation>Lösen in linearer Theorie</translation>
        </message>
        <message>
            <source>judging linear theory</source>
            <translation>lineare Theorie wird beurteilt</translation>
        </message>
        <message>
            <source>estimating the error of the cells</source>
            <translation>Fehler der Zellen wird geschätzt</translation>
        </message>
        <message>
            <source>displacements of the cells</source>
            <translation>Verschiebungen der Zellen</translation>
        </message>
        <message>
            <source>strains</source>
            <translation>Dehnungen</translation>
        </message>
        <message>
            <source>comparing both answers</source>
            <translation>beide Antworten werden verglichen</translation>
        </message>
        <message>
            <source>estimating how sure the answer is</source>
            <translation>Sicherheit der Antwort wird geschätzt</translation>
        </message>
        <message>
            <source>making the surface</source>
            <translation>Oberfläche wird gemacht</translation>
        </message>
        <message>
            <source>writing displacements</source>
            <translation>Verschiebungen werden geschrieben</translation>
        </message>
        <message>
            <source>keeping what the pictures show</source>
            <translation>Inhalt der Bilder wird gesichert</translation>
        </message>
        <message>
            <source>drawing slices</source>
            <translation>Schichten werden gezeichnet</translation>
        </message>
        <message>
            <source>drawing in 3-D</source>
            <translation>3-D wird gezeichnet</translation>
        </message>
        <message>
            <source>writing a SOFA scene</source>
            <translation>SOFA-Szene wird geschrieben</translation>
        </message>
        <message>
            <source>writing the report</source>
            <translation>Bericht wird geschrieben</translation>
        </message>
        <message>
            <source>placing the outlines</source>
            <translation>Konturen werden gelegt</translation>
        </message>
        <message>
            <source>reading files</source>
            <translation>Dateien werden gelesen</translation>
        </message>
        <message>
            <source>reading slices</source>
            <translation>Schichten werden gelesen</translation>
        </message>
        <message>
            <source>reading image headers</source>
            <translation>Bildköpfe werden gelesen</translation>
        </message>
        <message>
            <source>looking at volume files</source>
            <translation>Volumendateien werden angesehen</translation>
        </message>
        <message>
            <source>making a synthetic patient</source>
            <translation>synthetischer Patient wird gemacht</translation>
        </message>
        <message>
            <source>laying the elastogram over the MRI</source>
            <translation>Elastogramm wird über die MRT gelegt</translation>
        </message>
        <message>
            <source>comparing readers</source>
            <translation>Befunder werden verglichen</translation>
        </message>
        <message>
            <source>growing a region</source>
            <translation>Region wächst</translation>
        </message>
        <message>
            <source>assembling</source>
            <translation>Aufstellen</translation>
        </message>
        <message>
            <source>factorising</source>
            <translation>Faktorisieren</translation>
        </message>
        <message>
            <source>solving</source>
            <translation>Lösen</translation>
        </message>
        <message>
            <source>making tetrahedra</source>
            <translation>Tetraeder werden gemacht</translation>
        </message>
        <message>
            <source>drawing charts</source>
            <translation>Diagramme werden gezeichnet</translation>
        </message>
        <message>
            <source>done</source>
            <translation>fertig</translation>
        </message>
        <message>
            <source>drawing how sure the answer is</source>
            <translation>Bilder der Sicherheit zeichnen</translation>
        </message>
        <message>
            <source>de-identifying</source>
            <translation>Pseudonymisieren</translation>
        </message>
        <message>
            <source>asking for studies</source>
            <translation>nach Studien wird gefragt</translation>
        </message>
        <message>
            <source>asking for series</source>
            <translation>nach Serien wird gefragt</translation>
        </message>
    </context>
    <context>
        <name>cohort</name>
        <message>
            <source>one MRI voxel</source>
            <translation>ein MRT-Voxel</translation>
        </message>
        <message>
            <source>clinically significant</source>
            <translation>klinisch bedeutsam</translation>
        </message>
        <message>
            <source>Difference at the retractor</source>
            <translation>Unterschied am Retraktor</translation>
        </message>
        <message>
            <source>Error of that by the cells</source>
            <translation>Dessen Fehler durch die Zellen</translation>
        </message>
        <message>
            <source>Mean difference</source>
            <translation>Mittlerer Unterschied</translation>
        </message>
        <message>
            <source>95 % of the liver within</source>
            <translation>95 % der Leber innerhalb</translation>
        </message>
        <message>
            <source>Largest difference</source>
            <translation>Größter Unterschied</translation>
        </message>
        <message>
            <source>Mean difference of vessels</source>
            <translation>Mittlerer Unterschied der Gefäße</translation>
        </message>
        <message>
            <source>Shear modulus µ</source>
            <translation>Schubmodul µ</translation>
        </message>
        <message>
            <source>textbook</source>
            <translation>Lehrbuch</translation>
        </message>
        <message>
            <source>SD of µ</source>
            <translation>SD von µ</translation>
        </message>
        <message>
            <source>Volume</source>
            <translation>Volumen</translation>
        </message>
        <message>
            <source>Travel of the bar</source>
            <translation>Weg des Stabs</translation>
        </message>
        <message>
            <source>Travel, measured less atlas</source>
            <translation>Weg, gemessen minus Atlas</translation>
        </message>
        <message>
            <source>Strain, 95 % below</source>
            <translation>Dehnung, 95 % darunter</translation>
        </message>
        <message>
            <source>Largest rotation</source>
            <translation>Größte Drehung</translation>
        </message>
    </context>
    <context>
        <name>figures</name>
        <message>
            <source>Mean stiffness of the liver</source>
            <translation>Mittlere Steifigkeit der Leber</translation>
        </message>
        <message>
            <source>SD of the stiffness</source>
            <translation>SD der Steifigkeit</translation>
        </message>
        <message>
            <source>Volume</source>
            <translation>Volumen</translation>
        </message>
        <message>
            <source>Difference at the retractor</source>
            <translation>Unterschied am Retraktor</translation>
        </message>
        <message>
            <source>Its error by the cells</source>
            <translation>Dessen Fehler durch die Zellen</translation>
        </message>
        <message>
            <source>Mean difference</source>
            <translation>Mittlerer Unterschied</translation>
        </message>
        <message>
            <source>95 % of the liver within</source>
            <translation>95 % der Leber innerhalb</translation>
        </message>
        <message>
            <source>Largest difference</source>
            <translation>Größter Unterschied</translation>
        </message>
        <message>
            <source>Mean difference of vessels</source>
            <translation>Mittlerer Unterschied der Gefäße</translation>
        </message>
        <message>
            <source>Vessels 5 mm apart or more</source>
            <translation>Gefäße mit 5 mm Abstand oder mehr</translation>
        </message>
        <message>
            <source>Travel of the bar, measured</source>
            <translation>Weg des Stabs, gemessen</translation>
        </message>
        <message>
            <source>Travel of the bar, atlas</source>
            <translation>Weg des Stabs, Atlas</translation>
        </message>
        <message>
            <source>Force along the hoist</source>
            <translation>Kraft entlang des Zugs</translation>
        </message>
        <message>
            <source>Contact area</source>
            <translation>Kontaktfläche</translation>
        </message>
        <message>
            <source>Largest pressure</source>
            <translation>Größter Druck</translation>
        </message>
        <message>
            <source>Largest displacement</source>
            <translation>Größte Verschiebung</translation>
        </message>
        <message>
            <source>Strain, 95 % below</source>
            <translation>Dehnung, 95 % darunter</translation>
        </message>
        <message>
            <source>Largest rotation</source>
            <translation>Größte Drehung</translation>
        </message>
        <message>
            <source>Error of a place by the cells</source>
            <translation>Fehler eines Orts durch die Zellen</translation>
        </message>
        <message>
            <source>Unknowns</source>
            <translation>Unbekannte</translation>
        </message>
    </context>
    <context>
        <name>formats</name>
        <message>
            <source>RT Structure Set of the outlines</source>
            <translation>RT Structure Set der Konturen</translation>
        </message>
        <message>
            <source>Segmentation of the liver</source>
            <translation>Segmentation der Leber</translation>
        </message>
        <message>
            <source>Parametric Map of the stiffness in kPa</source>
            <translation>Parametric Map der Steifigkeit in kPa</translation>
        </message>
        <message>
            <source>Structured report of the stiffness (TID 1500)</source>
            <translation>Strukturierter Bericht der Steifigkeit (TID 1500)</translation>
        </message>
        <message>
            <source>Pictures of the run as Secondary Captures</source>
            <translation>Bilder des Laufs als Secondary Captures</translation>
        </message>
        <message>
            <source>Liver mask as NIfTI</source>
            <translation>Lebermaske als NIfTI</translation>
        </message>
        <message>
            <source>Liver mask as 3D Slicer segmentation</source>
            <translation>Lebermaske als 3D-Slicer-Segmentierung</translation>
        </message>
        <message>
            <source>Outlines as JSON</source>
            <translation>Konturen als JSON</translation>
        </message>
        <message>
            <source>Outlines as 3D Slicer markups</source>
            <translation>Konturen als 3D-Slicer-Markups</translation>
        </message>
        <message>
            <source>Displacement field as 4-D NRRD</source>
            <translation>Verschiebungsfeld als 4-D-NRRD</translation>
        </message>
        <message>
            <source>VTK meshes, at rest and deformed (ParaView)</source>
            <translation>VTK-Netze, in Ruhe und verformt (ParaView)</translation>
        </message>
        <message>
            <source>Stiffness and mass matrix as Matrix Market</source>
            <translation>Steifigkeits- und Massenmatrix als Matrix Market</translation>
        </message>
        <message>
            <source>3D Slicer scene with images, outlines, surfaces</source>
            <translation>3D-Slicer-Szene mit Bildern, Konturen, Oberflächen</translation>
        </message>
        <message>
            <source>SOFA scene</source>
            <translation>SOFA-Szene</translation>
        </message>
        <message>
            <source>Stiffness and displacement as a table (CSV)</source>
            <translation>Steifigkeit und Verschiebung als Tabelle (CSV)</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::CohortModel</name>
        <message>
            <source>done</source>
            <translation>fertig</translation>
        </message>
        <message>
            <source>left out</source>
            <translation>weggelassen</translation>
        </message>
        <message>
            <source>failed</source>
            <translation>gescheitert</translation>
        </message>
        <message>
            <source>Patient</source>
            <translation>Patient</translation>
        </message>
        <message>
            <source>State</source>
            <translation>Stand</translation>
        </message>
        <message>
            <source>Why</source>
            <translation>Grund</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::CohortWindow</name>
        <message>
            <source>Cohort</source>
            <translation>Kohorte</translation>
        </message>
        <message>
            <source>Open patient</source>
            <translation>Patient öffnen</translation>
        </message>
        <message>
            <source>Shows the patient chosen in the table in the window</source>
            <translation>Zeigt den in der Tabelle gewählten Patienten im Fenster</translation>
        </message>
        <message>
            <source>Results of a cohort, or a folder of runs and saved cases</source>
            <translation>Ergebnisse einer Kohorte, oder ein Ordner mit Läufen und gespeicherten Fällen</translation>
        </message>
        <message>
            <source>Folder of a cohort or of runs</source>
            <translation>Ordner einer Kohorte oder von Läufen</translation>
        </message>
        <message>
            <source>Patient, state, reason or warning</source>
            <translation>Patient, Stand, Grund oder Warnung</translation>
        </message>
        <message>
            <source>Figure of the charts and limits</source>
            <translation>Größe der Diagramme und Grenzen</translation>
        </message>
        <message>
            <source>from</source>
            <translation>von</translation>
        </message>
        <message>
            <source>to</source>
            <translation>bis</translation>
        </message>
        <message>
            <source>Show</source>
            <translation>Zeigen</translation>
        </message>
        <message>
            <source>Patients</source>
            <translation>Patienten</translation>
        </message>
        <message>
            <source>Click: chooses the patients of a column; double-click: opens the first of them</source>
            <translation>Klick: wählt die Patienten einer Säule; Doppelklick: öffnet den ersten davon</translation>
        </message>
        <message>
            <source>Click: chooses the patient nearest to that height; double-click: opens it</source>
            <translation>Klick: wählt den Patienten, der dieser Höhe am nächsten liegt; Doppelklick: öffnet ihn</translation>
        </message>
        <message>
            <source>Reading</source>
            <translation>Lesen</translation>
        </message>
        <message>
            <source>Folders that hold nothing to show: %1.</source>
            <translation>Ordner, in denen nichts zu zeigen ist: %1.</translation>
        </message>
        <message>
            <source>%1 of %2 patients</source>
            <translation>%1 von %2 Patienten</translation>
        </message>
        <message>
            <source>Choose the folder of a cohort or of runs: its figures appear here.</source>
            <translation>Den Ordner einer Kohorte oder von Läufen wählen: hier erscheinen ihre Zahlen.</translation>
        </message>
        <message>
            <source>No patient that is shown has this figure.</source>
            <translation>Kein gezeigter Patient hat diese Größe.</translation>
        </message>
        <message>
            <source>shown</source>
            <translation>gezeigt</translation>
        </message>
        <message>
            <source>%1: mean %2, SD %3, median %4, %5 to %6, n = %7</source>
            <translation>%1: Mittel %2, SD %3, Median %4, %5 bis %6, n = %7</translation>
        </message>
        <message>
            <source>The images of this run are not where it says.</source>
            <translation>Die Bilder dieses Laufs sind nicht dort, wo er sagt.</translation>
        </message>
        <message>
            <source>Folder of the patients, that the cohort was run over</source>
            <translation>Ordner der Patienten, über die die Kohorte gerechnet wurde</translation>
        </message>
        <message>
            <source>Looking for the patient</source>
            <translation>Der Patient wird gesucht</translation>
        </message>
        <message>
            <source>The files of this patient are not known to be those that the result was made of: they have changed, or another version or a scene of its own was used. Open them?</source>
            <translation>Ob das Ergebnis aus den Dateien dieses Patienten entstand, ist nicht sicher: sie haben sich geändert, oder es war eine andere Version oder eine eigene Szene. Trotzdem öffnen?</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::DeidentifyDialog</name>
        <message>
            <source>De-identify</source>
            <translation>Pseudonymisieren</translation>
        </message>
        <message>
            <source>Copies DICOM files without what identifies the patient: the basic profile of PS3.15, and stricter on free text. The files that are read stay as they are.</source>
            <translation>Kopiert DICOM-Dateien ohne das, was den Patienten erkennen lässt: das Grundprofil von PS3.15, bei freiem Text strenger. Die gelesenen Dateien bleiben, wie sie sind.</translation>
        </message>
        <message>
            <source>From</source>
            <translation>Aus</translation>
        </message>
        <message>
            <source>DICOM folder to read</source>
            <translation>DICOM-Ordner, der gelesen wird</translation>
        </message>
        <message>
            <source>Into</source>
            <translation>Nach</translation>
        </message>
        <message>
            <source>Folder for the copies, new or empty</source>
            <translation>Ordner für die Kopien, neu oder leer</translation>
        </message>
        <message>
            <source>Folder for the copies</source>
            <translation>Ordner für die Kopien</translation>
        </message>
        <message>
            <source>Key file of the project</source>
            <translation>Schlüsseldatei des Projekts</translation>
        </message>
        <message>
            <source>Pseudonyms follow from it; made where there is none. Keep it apart from the copies.</source>
            <translation>Aus ihr folgen die Pseudonyme; fehlt sie, wird sie gemacht. Getrennt von den Kopien aufbewahren.</translation>
        </message>
        <message>
            <source>Keep dates, all of one patient shifted by the same days</source>
            <translation>Daten behalten, alle eines Patienten um gleich viele Tage verschoben</translation>
        </message>
        <message>
            <source>Keep the technical words of descriptions</source>
            <translation>Technische Wörter der Beschreibungen behalten</translation>
        </message>
        <message>
            <source>Keep age, sex, size and weight</source>
            <translation>Alter, Geschlecht, Größe und Gewicht behalten</translation>
        </message>
        <message>
            <source>Open the copies</source>
            <translation>Kopien öffnen</translation>
        </message>
        <message>
            <source>Opens the folder that was written</source>
            <translation>Öffnet den geschriebenen Ordner</translation>
        </message>
        <message>
            <source>De-identifying</source>
            <translation>Pseudonymisierung</translation>
        </message>
        <message>
            <source>Nothing was written</source>
            <translation>Nichts wurde geschrieben</translation>
        </message>
        <message>
            <source>Files written: %1, patients: %2</source>
            <translation>Dateien geschrieben: %1, Patienten: %2</translation>
        </message>
        <message>
            <source>Attributes changed in these files:</source>
            <translation>In diesen Dateien geänderte Attribute:</translation>
        </message>
        <message>
            <source>removed</source>
            <translation>entfernt</translation>
        </message>
        <message>
            <source>private ones removed</source>
            <translation>private entfernt</translation>
        </message>
        <message>
            <source>emptied</source>
            <translation>geleert</translation>
        </message>
        <message>
            <source>replaced by a pseudonym or a word of no meaning</source>
            <translation>durch ein Pseudonym oder ein Wort ohne Bedeutung ersetzt</translation>
        </message>
        <message>
            <source>dates shifted</source>
            <translation>Daten verschoben</translation>
        </message>
        <message>
            <source>dates taken away</source>
            <translation>Daten weggenommen</translation>
        </message>
        <message>
            <source>UIDs mapped by the key</source>
            <translation>UIDs nach dem Schlüssel ersetzt</translation>
        </message>
        <message>
            <source>codes of unknown schemes</source>
            <translation>Codes unbekannter Schemata</translation>
        </message>
        <message>
            <source>%1 × a file that %2</source>
            <translation>%1 × eine Datei: %2</translation>
        </message>
        <message>
            <source>Left out</source>
            <translation>Weggelassen</translation>
        </message>
        <message>
            <source>A new key file was made: with another one, pseudonyms would be others.</source>
            <translation>Eine neue Schlüsseldatei wurde gemacht: mit einer anderen wären es andere Pseudonyme.</translation>
        </message>
        <message>
            <source>To be known</source>
            <translation>Zu wissen</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::ExportDialog</name>
        <message>
            <source>Export</source>
            <translation>Exportieren</translation>
        </message>
        <message>
            <source>Folder</source>
            <translation>Ordner</translation>
        </message>
        <message>
            <source>Where the files are written</source>
            <translation>Wohin die Dateien geschrieben werden</translation>
        </message>
        <message>
            <source>Folder for the export</source>
            <translation>Ordner für den Export</translation>
        </message>
        <message>
            <source>Replace files of the same name</source>
            <translation>Dateien gleichen Namens ersetzen</translation>
        </message>
        <message>
            <source>Otherwise the folder must be new or empty</source>
            <translation>Sonst muss der Ordner neu oder leer sein</translation>
        </message>
        <message>
            <source>Case in the table, no patient&apos;s name</source>
            <translation>Fall in der Tabelle, kein Patientenname</translation>
        </message>
        <message>
            <source>Reader in the table</source>
            <translation>Befunder in der Tabelle</translation>
        </message>
        <message>
            <source>DICOM</source>
            <translation>DICOM</translation>
        </message>
        <message>
            <source>Images and outlines</source>
            <translation>Bilder und Konturen</translation>
        </message>
        <message>
            <source>Meshes and matrices</source>
            <translation>Netze und Matrizen</translation>
        </message>
        <message>
            <source>Other programs</source>
            <translation>Andere Programme</translation>
        </message>
        <message>
            <source>Tables</source>
            <translation>Tabellen</translation>
        </message>
        <message>
            <source>Needs an accepted outline of the liver.</source>
            <translation>Braucht eine angenommene Kontur der Leber.</translation>
        </message>
        <message>
            <source>Needs an elastogram and an accepted outline of the liver.</source>
            <translation>Braucht ein Elastogramm und eine angenommene Kontur der Leber.</translation>
        </message>
        <message>
            <source>Needs a run of what is shown: run the retraction first.</source>
            <translation>Braucht einen Lauf dessen, was gezeigt wird: zuerst die Retraktion rechnen.</translation>
        </message>
        <message>
            <source>Exporting</source>
            <translation>Export</translation>
        </message>
        <message>
            <source>Nothing was written</source>
            <translation>Nichts wurde geschrieben</translation>
        </message>
        <message>
            <source>Not written</source>
            <translation>Nicht geschrieben</translation>
        </message>
        <message>
            <source>Files written: %1</source>
            <translation>Dateien geschrieben: %1</translation>
        </message>
        <message>
            <source>To be known</source>
            <translation>Zu wissen</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::PacsDialog</name>
        <message>
            <source>PACS</source>
            <translation>PACS</translation>
        </message>
        <message>
            <source>Find and fetch</source>
            <translation>Suchen und holen</translation>
        </message>
        <message>
            <source>Send</source>
            <translation>Senden</translation>
        </message>
        <message>
            <source>My server</source>
            <translation>Mein Server</translation>
        </message>
        <message>
            <source>Servers that are kept; the name can be changed</source>
            <translation>Gemerkte Server; der Name lässt sich ändern</translation>
        </message>
        <message>
            <source>Server</source>
            <translation>Server</translation>
        </message>
        <message>
            <source>Add</source>
            <translation>Hinzufügen</translation>
        </message>
        <message>
            <source>One more server</source>
            <translation>Ein weiterer Server</translation>
        </message>
        <message>
            <source>Remove</source>
            <translation>Entfernen</translation>
        </message>
        <message>
            <source>Forgets this server</source>
            <translation>Vergisst diesen Server</translation>
        </message>
        <message>
            <source>Does it answer?</source>
            <translation>Antwortet er?</translation>
        </message>
        <message>
            <source>Asks the server whether it is there and knows us (C-ECHO)</source>
            <translation>Fragt den Server, ob er da ist und uns kennt (C-ECHO)</translation>
        </message>
        <message>
            <source>Name or address</source>
            <translation>Name oder Adresse</translation>
        </message>
        <message>
            <source>The server&apos;s name or address</source>
            <translation>Name oder Adresse des Servers</translation>
        </message>
        <message>
            <source>The server&apos;s port</source>
            <translation>Port des Servers</translation>
        </message>
        <message>
            <source>Its AE title</source>
            <translation>Sein AE-Titel</translation>
        </message>
        <message>
            <source>The server&apos;s AE title</source>
            <translation>AE-Titel des Servers</translation>
        </message>
        <message>
            <source>Our AE title</source>
            <translation>Unser AE-Titel</translation>
        </message>
        <message>
            <source>Our AE title, by which the server knows us</source>
            <translation>Unser AE-Titel, unter dem der Server uns kennt</translation>
        </message>
        <message>
            <source>Fetch by C-MOVE, received at</source>
            <translation>Holen mit C-MOVE, Empfang auf</translation>
        </message>
        <message>
            <source>For servers without C-GET. They must know our AE title, this computer and this port.</source>
            <translation>Für Server ohne C-GET. Sie müssen unseren AE-Titel, diesen Rechner und diesen Port kennen.</translation>
        </message>
        <message>
            <source>Our port, to which the server sends</source>
            <translation>Unser Port, an den der Server sendet</translation>
        </message>
        <message>
            <source>The connection is not encrypted: for a trusted network only.</source>
            <translation>Die Verbindung ist nicht verschlüsselt: nur für ein vertrauenswürdiges Netz.</translation>
        </message>
        <message>
            <source>Server %1</source>
            <translation>Server %1</translation>
        </message>
        <message>
            <source>Asking</source>
            <translation>Anfrage</translation>
        </message>
        <message>
            <source>The server answers after %1 ms.</source>
            <translation>Der Server antwortet nach %1 ms.</translation>
        </message>
        <message>
            <source>* stands for any text, ? for any letter</source>
            <translation>* steht für beliebigen Text, ? für einen Buchstaben</translation>
        </message>
        <message>
            <source>Patient ID</source>
            <translation>Patienten-ID</translation>
        </message>
        <message>
            <source>Patient name</source>
            <translation>Patientenname</translation>
        </message>
        <message>
            <source>Study date</source>
            <translation>Studiendatum</translation>
        </message>
        <message>
            <source>2026-01-31, or a range: 2026-01-01..2026-01-31, 2026-01-01..</source>
            <translation>2026-01-31, oder ein Zeitraum: 2026-01-01..2026-01-31, 2026-01-01..</translation>
        </message>
        <message>
            <source>Modality</source>
            <translation>Modalität</translation>
        </message>
        <message>
            <source>MR, for instance</source>
            <translation>Zum Beispiel MR</translation>
        </message>
        <message>
            <source>Description</source>
            <translation>Beschreibung</translation>
        </message>
        <message>
            <source>Accession number</source>
            <translation>Auftragsnummer</translation>
        </message>
        <message>
            <source>Show who the patients are</source>
            <translation>Zeigen, wer die Patienten sind</translation>
        </message>
        <message>
            <source>Otherwise patients are numbered, and their names are not even asked for</source>
            <translation>Sonst werden Patienten nummeriert, und nach ihren Namen wird nicht einmal gefragt</translation>
        </message>
        <message>
            <source>Find</source>
            <translation>Suchen</translation>
        </message>
        <message>
            <source>Lists studies and their series (C-FIND)</source>
            <translation>Listet Studien und ihre Serien (C-FIND)</translation>
        </message>
        <message>
            <source>Studies found</source>
            <translation>Gefundene Studien</translation>
        </message>
        <message>
            <source>Patient</source>
            <translation>Patient</translation>
        </message>
        <message>
            <source>Date</source>
            <translation>Datum</translation>
        </message>
        <message>
            <source>Series</source>
            <translation>Serien</translation>
        </message>
        <message>
            <source>Images</source>
            <translation>Bilder</translation>
        </message>
        <message>
            <source>Folder for what is fetched; each study gets one of its own in it</source>
            <translation>Ordner für das Geholte; jede Studie bekommt darin einen eigenen</translation>
        </message>
        <message>
            <source>Folder for what is fetched</source>
            <translation>Ordner für das Geholte</translation>
        </message>
        <message>
            <source>Fetch</source>
            <translation>Holen</translation>
        </message>
        <message>
            <source>Fetches the studies or series chosen in the list</source>
            <translation>Holt die in der Liste gewählten Studien oder Serien</translation>
        </message>
        <message>
            <source>Open what was fetched</source>
            <translation>Geholtes öffnen</translation>
        </message>
        <message>
            <source>Opens it in the window</source>
            <translation>Öffnet es im Fenster</translation>
        </message>
        <message>
            <source>Patient %1</source>
            <translation>Patient %1</translation>
        </message>
        <message>
            <source>Series %1</source>
            <translation>Serie %1</translation>
        </message>
        <message>
            <source>The server has nothing of that kind.</source>
            <translation>Der Server hat nichts dergleichen.</translation>
        </message>
        <message>
            <source>%1 studies; there are more: narrow what you look for.</source>
            <translation>%1 Studien; es gibt mehr: die Suche eingrenzen.</translation>
        </message>
        <message>
            <source>Studies found: %1.</source>
            <translation>Gefundene Studien: %1.</translation>
        </message>
        <message>
            <source>Fetching</source>
            <translation>Holen</translation>
        </message>
        <message>
            <source>%1 What has arrived is kept.</source>
            <translation>%1 Was ankam, bleibt.</translation>
        </message>
        <message>
            <source>Images fetched: %1, there already: %2.</source>
            <translation>Bilder geholt: %1, schon da: %2.</translation>
        </message>
        <message>
            <source>Not everything has arrived: fetch again.</source>
            <translation>Nicht alles ist angekommen: noch einmal holen.</translation>
        </message>
        <message>
            <source>Refused: %1 (%2).</source>
            <translation>Abgelehnt: %1 (%2).</translation>
        </message>
        <message>
            <source>What is shown, as DICOM</source>
            <translation>Was gezeigt wird, als DICOM</translation>
        </message>
        <message>
            <source>Files and folders</source>
            <translation>Dateien und Ordner</translation>
        </message>
        <message>
            <source>Files and folders to send</source>
            <translation>Dateien und Ordner zum Senden</translation>
        </message>
        <message>
            <source>Add files…</source>
            <translation>Dateien hinzufügen…</translation>
        </message>
        <message>
            <source>DICOM files to send</source>
            <translation>DICOM-Dateien zum Senden</translation>
        </message>
        <message>
            <source>Add folder…</source>
            <translation>Ordner hinzufügen…</translation>
        </message>
        <message>
            <source>All DICOM files below a folder</source>
            <translation>Alle DICOM-Dateien unter einem Ordner</translation>
        </message>
        <message>
            <source>Clear</source>
            <translation>Leeren</translation>
        </message>
        <message>
            <source>Takes all from the list</source>
            <translation>Nimmt alles aus der Liste</translation>
        </message>
        <message>
            <source>Stores it on the server (C-STORE)</source>
            <translation>Legt es auf dem Server ab (C-STORE)</translation>
        </message>
        <message>
            <source>Folder to send</source>
            <translation>Ordner zum Senden</translation>
        </message>
        <message>
            <source>Needs an outlined liver, with elastogram or run where these are told of.</source>
            <translation>Braucht eine umrissene Leber, mit Elastogramm oder Lauf, wo davon die Rede ist.</translation>
        </message>
        <message>
            <source>Sending</source>
            <translation>Senden</translation>
        </message>
        <message>
            <source>Objects sent: %1.</source>
            <translation>Objekte gesendet: %1.</translation>
        </message>
        <message>
            <source>Not sent: %1 (%2).</source>
            <translation>Nicht gesendet: %1 (%2).</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::PreferencesDialog</name>
        <message>
            <source>Preferences</source>
            <translation>Einstellungen</translation>
        </message>
        <message>
            <source>Kept for the next start. Parameters of a patient are no preferences: they are in its case.</source>
            <translation>Gilt auch beim nächsten Start. Parameter eines Patienten sind keine Einstellungen: sie stehen in seinem Fall.</translation>
        </message>
        <message>
            <source>Close</source>
            <translation>Schließen</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::RunComparison</name>
        <message>
            <source>Compare two runs</source>
            <translation>Zwei Läufe vergleichen</translation>
        </message>
        <message>
            <source>First run</source>
            <translation>Erster Lauf</translation>
        </message>
        <message>
            <source>Second run</source>
            <translation>Zweiter Lauf</translation>
        </message>
        <message>
            <source>Another run…</source>
            <translation>Anderer Lauf…</translation>
        </message>
        <message>
            <source>The folder of a run, or of a case that keeps one</source>
            <translation>Der Ordner eines Laufs, oder eines Falls, der einen behält</translation>
        </message>
        <message>
            <source>against</source>
            <translation>gegen</translation>
        </message>
        <message>
            <source>Figures</source>
            <translation>Zahlen</translation>
        </message>
        <message>
            <source>Set otherwise</source>
            <translation>Anders eingestellt</translation>
        </message>
        <message>
            <source>Settings that differ</source>
            <translation>Einstellungen, die sich unterscheiden</translation>
        </message>
        <message>
            <source>Folder of a run, or of a case that keeps one</source>
            <translation>Ordner eines Laufs, oder eines Falls, der einen behält</translation>
        </message>
        <message>
            <source>Reading</source>
            <translation>Lesen</translation>
        </message>
        <message>
            <source>Run %1 from a folder</source>
            <translation>Lauf %1 aus einem Ordner</translation>
        </message>
        <message>
            <source>There is no run yet: run the retraction, or choose the folder of a run.</source>
            <translation>Es gibt noch keinen Lauf: die Retraktion rechnen, oder den Ordner eines Laufs wählen.</translation>
        </message>
        <message>
            <source>This is one run twice: choose another, run again, or take the folder of a run.</source>
            <translation>Das ist zweimal derselbe Lauf: einen anderen wählen, noch einmal rechnen, oder den Ordner eines Laufs nehmen.</translation>
        </message>
        <message>
            <source>The two runs are of different images.</source>
            <translation>Die beiden Läufe sind von verschiedenen Bildern.</translation>
        </message>
        <message>
            <source>Both runs have the same images, outlines and settings.</source>
            <translation>Beide Läufe haben dieselben Bilder, Konturen und Einstellungen.</translation>
        </message>
        <message>
            <source>Same images, other outlines.</source>
            <translation>Dieselben Bilder, andere Konturen.</translation>
        </message>
        <message>
            <source>Same images and outlines, other settings.</source>
            <translation>Dieselben Bilder und Konturen, andere Einstellungen.</translation>
        </message>
        <message>
            <source>Figure</source>
            <translation>Größe</translation>
        </message>
        <message>
            <source>Difference</source>
            <translation>Unterschied</translation>
        </message>
        <message>
            <source>Setting of the scene</source>
            <translation>Einstellung der Szene</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::WorkDialog</name>
        <message>
            <source>Cancel</source>
            <translation>Abbrechen</translation>
        </message>
        <message>
            <source>Stops the work; what is complete stays</source>
            <translation>Hält die Arbeit an; was vollständig ist, bleibt</translation>
        </message>
        <message>
            <source>Close</source>
            <translation>Schließen</translation>
        </message>
        <message>
            <source>Cancelling</source>
            <translation>Wird abgebrochen</translation>
        </message>
        <message>
            <source>Choose…</source>
            <translation>Wählen…</translation>
        </message>
        <message>
            <source>cancelled</source>
            <translation>abgebrochen</translation>
        </message>
    </context>
    <context>
        <name>glisson::session::RunHistory</name>
        <message>
            <source>Run at %1</source>
            <translation>Lauf um %1</translation>
        </message>
        <message>
            <source>Run kept in the case</source>
            <translation>Im Fall behaltener Lauf</translation>
        </message>
    </context>
    <context>
        <name>glisson::panels::TrustPanel</name>
        <message>
            <source>Run in large deformation</source>
            <translation>In großer Verformung rechnen</translation>
        </message>
        <message>
            <source>Halve the cells and run</source>
            <translation>Zellen halbieren und rechnen</translation>
        </message>
        <message>
            <source>Ask for %1 N and run</source>
            <translation>%1 N verlangen und rechnen</translation>
        </message>
        <message>
            <source>Find a place and run</source>
            <translation>Stelle suchen und rechnen</translation>
        </message>
        <message>
            <source>Kinematics: hyperelastic, on voxel hexahedra at rest. It takes some minutes.</source>
            <translation>Kinematik: hyperelastisch, auf Voxel-Hexaedern in Ruhe. Das dauert einige Minuten.</translation>
        </message>
        <message>
            <source>Tetrahedra of %1 mm: about eight times the run time</source>
            <translation>Tetraeder von %1 mm: etwa achtfache Rechenzeit</translation>
        </message>
        <message>
            <source>Cells of %1 mm: about eight times the run time</source>
            <translation>Zellen von %1 mm: etwa achtfache Rechenzeit</translation>
        </message>
        <message>
            <source>Nine tenths of what both livers bore at this place</source>
            <translation>Neun Zehntel dessen, was beide Lebern an dieser Stelle getragen haben</translation>
        </message>
        <message>
            <source>In place of where the bar was laid by hand</source>
            <translation>Anstelle des von Hand gelegten Stabs</translation>
        </message>
        <message>
            <source>Results of earlier outlines and other parameters, not of those shown now</source>
            <translation>Ergebnisse früherer Umrisse und anderer Parameter, nicht der jetzt gezeigten</translation>
        </message>
        <message>
            <source>Results of earlier outlines, not of those shown now</source>
            <translation>Ergebnisse früherer Umrisse, nicht der jetzt gezeigten</translation>
        </message>
        <message>
            <source>Results of other parameters, not of those set now</source>
            <translation>Ergebnisse anderer Parameter, nicht der jetzt eingestellten</translation>
        </message>
        <message>
            <source>Results of an earlier state of this case, not of what is shown now</source>
            <translation>Ergebnisse eines früheren Stands dieses Falls, nicht des jetzt gezeigten</translation>
        </message>
        <message>
            <source>How much the size of the cells matters is not known: %1</source>
            <translation>Wie viel die Größe der Zellen ausmacht, ist nicht bekannt: %1</translation>
        </message>
        <message>
            <source>The cells of %1 mm may shift a place by %2 mm on average, and by no more than %3 mm in 95 % of the liver (estimated from cells twice as large).</source>
            <translation>Die Zellen von %1 mm können eine Stelle im Mittel um %2 mm verschieben, in 95 % der Leber um höchstens %3 mm (geschätzt aus doppelt so großen Zellen).</translation>
        </message>
        <message>
            <source>Most of it is common to both answers: the difference shown errs by %1 mm on average.</source>
            <translation>Das meiste davon ist beiden Antworten gemeinsam: Der gezeigte Unterschied irrt im Mittel um %1 mm.</translation>
        </message>
        <message>
            <source>That is more than half of the mean difference: use smaller cells before concluding.</source>
            <translation>Das ist mehr als die Hälfte des mittleren Unterschieds: Vor einem Schluss kleinere Zellen nehmen.</translation>
        </message>
        <message>
            <source>Not run yet.</source>
            <translation>Noch nicht gerechnet.</translation>
        </message>
        <message>
            <source>No warning: strains and rotations of both answers are within linear theory.</source>
            <translation>Keine Warnung: Dehnungen und Drehungen beider Antworten liegen innerhalb der linearen Theorie.</translation>
        </message>
        <message>
            <source>No warning: the large deformation of both answers converged.</source>
            <translation>Keine Warnung: Die große Verformung beider Antworten ist konvergiert.</translation>
        </message>
    </context>
    <context>
        <name>trust</name>
        <message>
            <source>measured and atlas</source>
            <comment>of a stiffness, inside a sentence</comment>
            <translation>gemessen und Atlas</translation>
        </message>
        <message>
            <source>measured</source>
            <comment>of a stiffness, inside a sentence</comment>
            <translation>gemessen</translation>
        </message>
        <message>
            <source>atlas</source>
            <comment>of a stiffness, inside a sentence</comment>
            <translation>Atlas</translation>
        </message>
        <message>
            <source>MRE and atlas: %1</source>
            <translation>MRE und Atlas: %1</translation>
        </message>
        <message>
            <source>MRE: %1</source>
            <translation>MRE: %1</translation>
        </message>
        <message>
            <source>Atlas: %1</source>
            <translation>Atlas: %1</translation>
        </message>
        <message>
            <source>slips</source>
            <translation>rutscht ab</translation>
        </message>
        <message>
            <source>folds</source>
            <translation>faltet sich</translation>
        </message>
        <message>
            <source>cuts</source>
            <translation>schneidet ein</translation>
        </message>
        <message>
            <source>loads not borne</source>
            <translation>Lasten nicht getragen</translation>
        </message>
        <message>
            <source>not converged</source>
            <translation>nicht konvergiert</translation>
        </message>
        <message>
            <source>it moves the body by more than its size</source>
            <translation>verschiebt den Körper um mehr als seine Größe</translation>
        </message>
        <message>
            <source>a cell is turned inside out</source>
            <translation>eine Zelle ist umgestülpt</translation>
        </message>
    </context>
    <context>
        <name>advice</name>
        <message>
            <source>Check stiffness, supports and force on Model and Retract: one of them has another unit.</source>
            <translation>Steifigkeit, Lager und Kraft auf Modell und Retraktion prüfen: Eine davon hat eine andere Einheit.</translation>
        </message>
        <message>
            <source>Do not use what lies there. Smaller cells, or a smaller force, keep cells whole.</source>
            <translation>Nicht verwenden, was dort liegt. Kleinere Zellen oder eine kleinere Kraft halten Zellen heil.</translation>
        </message>
        <message>
            <source>Run it in large deformation (Model, Kinematics: hyperelastic).</source>
            <translation>In großer Verformung rechnen (Modell, Kinematik: hyperelastisch).</translation>
        </message>
        <message>
            <source>Ask for less, or lay the bar where the liver is thicker and level across it. What is borne is itself a result.</source>
            <translation>Weniger verlangen oder den Stab dorthin legen, wo die Leber dicker ist und quer zum Stab eben. Was getragen wird, ist selbst ein Ergebnis.</translation>
        </message>
        <message>
            <source>Ask for less, or take a thicker bar or other cells.</source>
            <translation>Weniger verlangen oder einen dickeren Stab oder andere Zellen nehmen.</translation>
        </message>
        <message>
            <source>Ask for less, or take a thicker bar or smaller cells.</source>
            <translation>Weniger verlangen oder einen dickeren Stab oder kleinere Zellen nehmen.</translation>
        </message>
        <message>
            <source>Only a held travel stays here: under a force the bar would move on.</source>
            <translation>Nur ein gehaltener Weg bleibt hier stehen: Unter einer Kraft ginge der Stab weiter.</translation>
        </message>
        <message>
            <source>Read this as the second of two equilibria, or lay the bar where the liver bears more.</source>
            <translation>Als zweites von zwei Gleichgewichten lesen oder den Stab dorthin legen, wo die Leber mehr trägt.</translation>
        </message>
        <message>
            <source>Ask for a smaller force, or hold the liver at more places.</source>
            <translation>Eine kleinere Kraft verlangen oder die Leber an mehr Stellen halten.</translation>
        </message>
        <message>
            <source>Do not quote what lies within a cell of that place; smaller cells show whether it stays.</source>
            <translation>Nicht angeben, was bis zu einer Zelle neben dieser Stelle liegt; kleinere Zellen zeigen, ob es bleibt.</translation>
        </message>
        <message>
            <source>Do not quote pressures or places beside the bar. A smaller force, a thicker bar or smaller cells help.</source>
            <translation>Keine Drücke und Stellen neben dem Stab angeben. Eine kleinere Kraft, ein dickerer Stab oder kleinere Zellen helfen.</translation>
        </message>
        <message>
            <source>Use none of its numbers. Ask for less, or take other cells.</source>
            <translation>Keine seiner Zahlen verwenden. Weniger verlangen oder andere Zellen nehmen.</translation>
        </message>
        <message>
            <source>Take more sites or another kernel, and compare with voxel hexahedra.</source>
            <translation>Mehr Stützstellen oder einen anderen Kern nehmen und mit Voxel-Hexaedern vergleichen.</translation>
        </message>
        <message>
            <source>Ask for less, take a shorter or thicker bar, or lay it by hand.</source>
            <translation>Weniger verlangen, einen kürzeren oder dickeren Stab nehmen oder ihn von Hand legen.</translation>
        </message>
        <message>
            <source>Smaller cells make this error smaller; until then quote it beside the numbers.</source>
            <translation>Kleinere Zellen machen diesen Fehler kleiner; bis dahin neben den Zahlen angeben.</translation>
        </message>
        <message>
            <source>Until then report the difference with its error, and no verdict.</source>
            <translation>Bis dahin den Unterschied mit seinem Fehler berichten und kein Urteil.</translation>
        </message>
        <message>
            <source>Mend the run that is named; its own reason says how.</source>
            <translation>Die genannte Rechnung in Ordnung bringen; ihr eigener Grund sagt, wie.</translation>
        </message>
        <message>
            <source>Check the number and its unit on Model and Retract.</source>
            <translation>Zahl und Einheit auf Modell und Retraktion prüfen.</translation>
        </message>
        <message>
            <source>Give the motion more time, where the liver at rest is wanted.</source>
            <translation>Der Bewegung mehr Zeit geben, wo die Leber in Ruhe gewünscht ist.</translation>
        </message>
        <message>
            <source>Compare area and pressure between runs with cells of one size only.</source>
            <translation>Fläche und Druck nur zwischen Rechnungen mit gleich großen Zellen vergleichen.</translation>
        </message>
    </context>
</TS>
