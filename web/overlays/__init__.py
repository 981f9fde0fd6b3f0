"""What can be drawn over the bodies. A further overlay is one more file and one more line here."""

from web.overlays.bounds import Bounds
from web.overlays.contacts import Contacts
from web.overlays.hits import Hits
from web.overlays.impulses import Impulses
from web.overlays.joints import Joints
from web.overlays.normals import Normals
from web.overlays.overlay import Overlay

OVERLAYS: tuple[type[Overlay], ...] = (Contacts, Normals, Impulses, Joints, Hits, Bounds)

__all__ = ["OVERLAYS", "Overlay"]
