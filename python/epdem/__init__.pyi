# SPDX-License-Identifier: GPL-2.0-or-later
from . import theory as theory
from .api import Calibration as Calibration
from .api import Case as Case
from .api import Fit as Fit
from .api import Run as Run
from .api import Scene as Scene
from .api import SceneRun as SceneRun
from .api import Stored as Stored
from .api import calibrate as calibrate
from .api import cite as cite
from .api import deck as deck
from .api import predict as predict
from .api import read as read
from .api import run as run
from .api import sweep as sweep

__version__: str
