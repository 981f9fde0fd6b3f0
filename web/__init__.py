"""The page: a viser view of a session or of a recording, in any number of browsers at once."""

from web.app import App
from web.listen import ListenError, PortInUse
from web.panels.effects import Cost
from web.replay import ReplayApp

__all__ = ["App", "Cost", "ListenError", "PortInUse", "ReplayApp"]
