"""The folders of the control panel, in their order. A further one is one more file and one more line here."""

from web.panels.comparing import ComparingPanel
from web.panels.desk import Desk, Panel
from web.panels.drive import DrivePanel
from web.panels.effects import EffectsPanel
from web.panels.events import EventsPanel
from web.panels.help import HelpPanel
from web.panels.joints import JointsPanel
from web.panels.laboratory import LaboratoryPanel
from web.panels.physics import PhysicsPanel
from web.panels.plots import PlotsPanel
from web.panels.recording import RecordingPanel
from web.panels.simulation import SimulationPanel
from web.panels.spawn import SpawnPanel
from web.panels.status import StatusPanel
from web.panels.view import ViewPanel

PANELS: tuple[type[Panel], ...] = (
    StatusPanel,
    SimulationPanel,
    DrivePanel,
    SpawnPanel,
    JointsPanel,
    PhysicsPanel,
    EffectsPanel,
    EventsPanel,
    ComparingPanel,
    ViewPanel,
    PlotsPanel,
    LaboratoryPanel,
    HelpPanel,
    RecordingPanel,
)

__all__ = ["PANELS", "Desk", "JointsPanel", "Panel", "SpawnPanel"]
