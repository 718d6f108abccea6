"""Types of the module sunder. Written by scenes/api/python/make_stubs.py."""
import os
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Dict, List, Optional, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str


class Accuracy:
    """Step, substeps and sweeps of the run of a scene."""
    @property
    def preset(self) -> str:
        """Name of the preset with these values: draft, realtime, accurate or reference; "custom"
        if there is none. Setting a name sets its values, and `full_detail` and
        `chip_size_factor` of the limits."""
    @preset.setter
    def preset(self, value: str) -> None: ...
    @property
    def dt_s(self) -> float:
        """Step in s: 1/60 divided by a whole number."""
    @dt_s.setter
    def dt_s(self, value: float) -> None: ...
    @property
    def substeps(self) -> int:
        """Substeps of a step."""
    @substeps.setter
    def substeps(self, value: int) -> None: ...
    @property
    def sweeps(self) -> int:
        """Sweeps of the contact solver in a substep."""
    @sweeps.setter
    def sweeps(self, value: int) -> None: ...


class Asset:
    """A solid of which a world can have any number. A material is the name of a built-in one, or
    the index that add_material() returned."""
    def __init__(self, mesh: Union[str, os.PathLike], material: Union[str, int] = 'concrete', nodes: str = '', convexes: int = 0, fit: str = 'hull:24', repair: str = 'auto', scale: float = 1.0, size_m: Optional[float] = None, cached: bool = False) -> None:
        """Makes an asset of a mesh file (.obj .ply .stl .off .gltf .glb), which is repaired and
        decomposed, or of a built-in solid: "box:X,Y,Z", "column:R,H", "torus:R,r",
        "grid:NX,NY,NZ", "voronoi:N", "hall:N".

        nodes: number of nodes of the decomposition, or a file of them. convexes: the most
        convexes. scale: metres for each unit of the file. size_m: longest side, in place of
        scale. cached: decompositions are kept on disk."""
    @staticmethod
    def from_boxes(boxes: List[Tuple[ArrayLike, ArrayLike]], material: Union[str, int] = 'concrete', anchored: bool = False) -> Asset:
        """Makes an asset of boxes, each a pair of its lowest and its highest corner. Boxes that
        touch or overlap hold together. anchored: fixed to the world from below."""
    @staticmethod
    def from_hulls(hulls: List[ArrayLike], material: Union[str, int] = 'concrete', anchored: bool = False) -> Asset:
        """Makes an asset of convexes, each the hull of an array of points (n, 3)."""
    @staticmethod
    def from_triangles(vertices: ArrayLike, triangles: ArrayLike, material: Union[str, int] = 'concrete', nodes: str = '', convexes: int = 0, fit: str = 'hull:24', repair: str = 'auto') -> Asset:
        """Makes an asset of a triangle mesh: arrays (n, 3) of points, and of vertex indices,
        counter-clockwise seen from outside. The mesh is repaired and decomposed as a file is."""
    @property
    def convexes(self) -> int:
        """Number of convexes."""
    @property
    def volume_m3(self) -> float:
        """Volume in m³; overlaps count once."""
    @property
    def anchored(self) -> bool:
        """True if any convex is fixed to the world."""
    @property
    def bounds(self) -> Tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lowest and highest corner of the bounding box."""
    def islands(self) -> List[Asset]:
        """Returns the parts that do not touch each other, each as an asset."""


class Bodies:
    """All bodies of a world at one instant, ascending by key, as read-only arrays. They keep their
    values after further steps, and after the world is gone."""
    def __len__(self) -> int:
        ...
    @property
    def keys(self) -> NDArray[np.uint32]:
        """Keys (n), uint32."""
    @property
    def positions(self) -> NDArray[np.float64]:
        """Centres of mass (n, 3), float64."""
    @property
    def rotations(self) -> NDArray[np.float64]:
        """Quaternions (n, 4), float64, in the order x, y, z, w."""
    @property
    def velocities(self) -> NDArray[np.float64]:
        """Velocities of the centres of mass (n, 3), float64, in m/s."""
    @property
    def angular_velocities(self) -> NDArray[np.float64]:
        """Angular velocities (n, 3), float64, in rad/s."""
    @property
    def is_static(self) -> NDArray[np.bool_]:
        """True for anchored bodies and those on a path (n), bool."""
    @property
    def asleep(self) -> NDArray[np.bool_]:
        """True for bodies at rest that are not simulated (n), bool."""


class Body:
    """A body at one instant."""
    @property
    def key(self) -> int:
        """Its key."""
    @property
    def root(self) -> int:
        """Key of the solid or ball that it was part of."""
    @property
    def position(self) -> NDArray[np.float64]:
        """Centre of mass."""
    @property
    def origin(self) -> NDArray[np.float64]:
        """Position of the origin of the frame that its solid was modelled in."""
    @property
    def rotation(self) -> NDArray[np.float64]:
        """Quaternion x, y, z, w."""
    @property
    def velocity(self) -> NDArray[np.float64]:
        """Velocity of the centre of mass in m/s."""
    @property
    def angular_velocity(self) -> NDArray[np.float64]:
        """Angular velocity in rad/s."""
    @property
    def mass_kg(self) -> float:
        """Mass."""
    @property
    def volume_m3(self) -> float:
        """Volume."""
    @property
    def convexes(self) -> int:
        """Number of convexes; 0 for a ball."""
    @property
    def is_static(self) -> bool:
        """True if it is anchored or on a path."""
    @property
    def is_kinematic(self) -> bool:
        """True if it is on a path."""
    @property
    def asleep(self) -> bool:
        """True if it is at rest and not simulated."""
    @property
    def name(self) -> str:
        """Name of its root; may be empty."""
    @property
    def user_data(self) -> int:
        """Number set by set_user_data()."""
    @property
    def category(self) -> int:
        """Category bits of its collision filter."""
    @property
    def mask(self) -> int:
        """Mask bits of its collision filter."""


class Break:
    """A body broke or cracked."""
    @property
    def time_s(self) -> float:
        """Time in s."""
    @property
    def parent(self) -> int:
        """Key of the body that broke."""
    @property
    def children(self) -> List[int]:
        """Keys of its pieces; a static remainder keeps the key of the parent."""
    @property
    def material(self) -> int:
        """Index of the material at the point of the break."""
    @property
    def point(self) -> NDArray[np.float64]:
        """Point of impact, or of the highest stress."""
    @property
    def energy_J(self) -> float:
        """Energy taken from the impact."""
    @property
    def new_area_m2(self) -> float:
        """New crack area."""
    @property
    def pieces(self) -> int:
        """Number of all pieces, those that became debris included; 1: only cracked."""


class CastHit:
    """A point that a ray or a moving ball meets."""
    @property
    def body(self) -> Optional[int]:
        """Key of the body; None for the ground."""
    @property
    def slot(self) -> int:
        """Number of the convex within the body."""
    @property
    def material(self) -> Optional[int]:
        """Index of the material; None for the ground plane."""
    @property
    def distance_m(self) -> float:
        """Distance along the ray."""
    @property
    def point(self) -> NDArray[np.float64]:
        """The point."""
    @property
    def normal(self) -> NDArray[np.float64]:
        """Unit normal, out of the body."""


class Contact:
    """A point where a body touches another."""
    @property
    def other(self) -> Optional[int]:
        """Key of the other body; None for the ground."""
    @property
    def point(self) -> NDArray[np.float64]:
        """The point."""
    @property
    def force(self) -> NDArray[np.float64]:
        """Force on the body in N, friction included."""


class Events:
    """Changes during the last step, and between it and the step before."""
    @property
    def breaks(self) -> List[Break]:
        """Bodies that broke or cracked."""
    @property
    def hits(self) -> List[Hit]:
        """Hits, if report_hits() was called."""
    @property
    def appeared(self) -> List[int]:
        """Keys of bodies that appeared."""
    @property
    def gone(self) -> List[int]:
        """Keys of bodies that are gone."""
    @property
    def fell_asleep(self) -> List[int]:
        """Keys of bodies that fell asleep."""
    @property
    def woke(self) -> List[int]:
        """Keys of bodies that woke."""
    @property
    def joints_lost(self) -> List[int]:
        """Keys of joints that broke, or lost a body."""


class FileError(OSError):
    """A file or folder cannot be written."""


class Frame:
    """All that is drawn and reported at one instant; it never changes. Arrays are read-only views
    that keep the frame alive."""
    @property
    def index(self) -> int:
        """Number from 0 on."""
    @property
    def time_s(self) -> float:
        """Time in s."""
    @property
    def bodies(self) -> FrameBodies:
        """The bodies."""
    @property
    def instances(self) -> NDArray[np.uint32]:
        """What is drawn (n, 3), uint32: the index of the mesh for mesh(), the place of the body in
        `bodies`, and the material, 0xffffffff for that of the mesh."""
    def mesh(self, index: int) -> Mesh:
        """Returns a mesh by its index in `instances`."""
    def world_vertices(self, instance: int) -> NDArray[np.float64]:
        """Returns the vertices of a row of `instances` in the world (n, 3), float64: a copy."""
    @property
    def debris_positions(self) -> NDArray[np.float32]:
        """Positions of debris (n, 3), float32."""
    @property
    def debris_radii_m(self) -> NDArray[np.float32]:
        """Radii of debris (n), float32."""
    @property
    def dust_positions(self) -> NDArray[np.float32]:
        """Positions of dust (n, 3), float32."""
    @property
    def breaks(self) -> List[Break]:
        """Breaks since the previous frame."""
    @property
    def report(self) -> Dict[str, Any]:
        """Counts, times and sums of the frame, with the names of the program's JSON."""
    @property
    def materials(self) -> List[str]:
        """Names of the materials by index."""
    def state_hash(self) -> str:
        """Returns 16 hexadecimal digits: equal digits, equal states."""


class FrameBodies:
    """The bodies of a frame, ascending by key, as read-only views that keep the frame alive."""
    def __len__(self) -> int:
        ...
    @property
    def keys(self) -> NDArray[np.uint64]:
        """Keys (n), uint64."""
    @property
    def previous_keys(self) -> NDArray[np.uint64]:
        """Key of the body that each was part of in the previous frame (n), uint64."""
    @property
    def positions(self) -> NDArray[np.float64]:
        """Centres of mass (n, 3), float64."""
    @property
    def rotations(self) -> NDArray[np.float64]:
        """Quaternions (n, 4), float64, in the order x, y, z, w."""
    @property
    def centers(self) -> NDArray[np.float64]:
        """Centres of mass in the frame that each solid was modelled in (n, 3), float64."""
    @property
    def velocities(self) -> NDArray[np.float64]:
        """Velocities of the centres of mass (n, 3), float64, in m/s."""
    @property
    def angular_velocities(self) -> NDArray[np.float64]:
        """Angular velocities (n, 3), float64, in rad/s."""
    @property
    def masses_kg(self) -> NDArray[np.float64]:
        """Masses (n), float64; 0 in frames of a recording."""
    @property
    def is_static(self) -> NDArray[np.bool_]:
        """True for anchored bodies and those on a path (n), bool."""
    @property
    def asleep(self) -> NDArray[np.bool_]:
        """True for bodies at rest that are not simulated (n), bool."""


class Hit:
    """Two bodies that met in a step."""
    @property
    def a(self) -> int:
        """Key of the first body."""
    @property
    def b(self) -> Optional[int]:
        """Key of the second body; None for the ground."""
    @property
    def point(self) -> NDArray[np.float64]:
        """The point."""
    @property
    def normal(self) -> NDArray[np.float64]:
        """Unit normal from a to b."""
    @property
    def speed_m_s(self) -> float:
        """Closing speed along the normal."""
    @property
    def mass_kg(self) -> float:
        """Effective mass along the normal."""


class InputError(ValueError):
    """The input is wrong: a scene, a mesh, a key, an option, or a file that cannot be read. The
    text names the place and what is allowed."""


class Limits:
    """Limits of a run, with the names of a scene file."""
    @property
    def bodies(self) -> int:
        """Most bodies."""
    @bodies.setter
    def bodies(self, value: int) -> None: ...
    @property
    def ageing(self) -> int:
        """Bodies from which the smallest fragments at rest become debris; 0: bodies."""
    @ageing.setter
    def ageing(self, value: int) -> None: ...
    @property
    def parts_a_frame(self) -> int:
        """Parts cut per frame."""
    @parts_a_frame.setter
    def parts_a_frame(self, value: int) -> None: ...
    @property
    def load_work_a_frame(self) -> int:
        """Bond evaluations per frame."""
    @load_work_a_frame.setter
    def load_work_a_frame(self, value: int) -> None: ...
    @property
    def debris(self) -> int:
        """Most pieces of debris."""
    @debris.setter
    def debris(self, value: int) -> None: ...
    @property
    def dust(self) -> int:
        """Most puffs of dust."""
    @dust.setter
    def dust(self, value: int) -> None: ...
    @property
    def impact_bonds(self) -> int:
        """Most bonds of a solid that impacts break by stress."""
    @impact_bonds.setter
    def impact_bonds(self, value: int) -> None: ...
    @property
    def impact_evaluations(self) -> int:
        """Bond evaluations of a plan by stress."""
    @impact_evaluations.setter
    def impact_evaluations(self, value: int) -> None: ...
    @property
    def loaded_convexes(self) -> int:
        """Least convexes of a piece that contacts break by stress."""
    @loaded_convexes.setter
    def loaded_convexes(self, value: int) -> None: ...
    @property
    def cluster_bodies(self) -> int:
        """Most bodies around an impact."""
    @cluster_bodies.setter
    def cluster_bodies(self, value: int) -> None: ...
    @property
    def probe_events(self) -> int:
        """Most events of a cluster in a step."""
    @probe_events.setter
    def probe_events(self, value: int) -> None: ...
    @property
    def break_rounds(self) -> int:
        """Rounds of breaks in a step."""
    @break_rounds.setter
    def break_rounds(self, value: int) -> None: ...
    @property
    def full_detail(self) -> int:
        """Awake bodies above which the smallest piece grows; 0: never."""
    @full_detail.setter
    def full_detail(self, value: int) -> None: ...
    @property
    def piece_size_factor(self) -> float:
        """Factor on the size of the smallest pieces."""
    @piece_size_factor.setter
    def piece_size_factor(self, value: float) -> None: ...
    @property
    def chip_size_factor(self) -> float:
        """Factor on the least radius of debris."""
    @chip_size_factor.setter
    def chip_size_factor(self, value: float) -> None: ...
    @property
    def passed_impacts(self) -> bool:
        """False: impacts break only the two bodies that meet."""
    @passed_impacts.setter
    def passed_impacts(self, value: bool) -> None: ...


class Material:
    """Density, strength and fracture pattern of a solid. Members have the names of the keys of a
    scene file."""
    def __init__(self, name: str, like: str = '') -> None:
        """Makes a material: a copy of the built-in one named by `like`, if given."""
    @property
    def name(self) -> str:
        """Name, which solids and balls refer to."""
    @name.setter
    def name(self, value: str) -> None: ...
    @property
    def density_kg_m3(self) -> float:
        """Density in kg/m³."""
    @density_kg_m3.setter
    def density_kg_m3(self, value: float) -> None: ...
    @property
    def friction(self) -> float:
        """Coefficient of friction."""
    @friction.setter
    def friction(self, value: float) -> None: ...
    @property
    def restitution(self) -> float:
        """Coefficient of restitution, 0 to 1."""
    @restitution.setter
    def restitution(self, value: float) -> None: ...
    @property
    def rolling(self) -> float:
        """Coefficient of rolling resistance."""
    @rolling.setter
    def rolling(self, value: float) -> None: ...
    @property
    def toughness_J_m2(self) -> float:
        """Energy per new crack area in J/m²."""
    @toughness_J_m2.setter
    def toughness_J_m2(self, value: float) -> None: ...
    @property
    def impact_radius_m(self) -> float:
        """Radius around an impact within which a solid breaks; inf: all of it."""
    @impact_radius_m.setter
    def impact_radius_m(self, value: float) -> None: ...
    @property
    def tensile_Pa(self) -> float:
        """Tensile strength; 0: unlimited."""
    @tensile_Pa.setter
    def tensile_Pa(self, value: float) -> None: ...
    @property
    def shear_Pa(self) -> float:
        """Shear strength; 0: unlimited."""
    @shear_Pa.setter
    def shear_Pa(self, value: float) -> None: ...
    @property
    def compressive_Pa(self) -> float:
        """Compressive strength; 0: unlimited."""
    @compressive_Pa.setter
    def compressive_Pa(self, value: float) -> None: ...
    @property
    def youngs_Pa(self) -> float:
        """Young's modulus."""
    @youngs_Pa.setter
    def youngs_Pa(self, value: float) -> None: ...
    @property
    def yield_Pa(self) -> float:
        """Yield stress; 0: brittle."""
    @yield_Pa.setter
    def yield_Pa(self, value: float) -> None: ...
    @property
    def hardening_Pa(self) -> float:
        """Increase of the yield stress per plastic strain."""
    @hardening_Pa.setter
    def hardening_Pa(self, value: float) -> None: ...
    @property
    def elongation(self) -> float:
        """Plastic strain at which a yielding section tears."""
    @elongation.setter
    def elongation(self, value: float) -> None: ...
    @property
    def smallest_piece_m3(self) -> float:
        """Volume below which pieces become debris."""
    @smallest_piece_m3.setter
    def smallest_piece_m3(self, value: float) -> None: ...
    @property
    def pattern(self) -> str:
        """Fracture pattern, such as "voronoi:50"; "none": unbreakable."""
    @pattern.setter
    def pattern(self, value: str) -> None: ...
    @property
    def color(self) -> NDArray[np.float64]:
        """Colour of the surface, linear RGB."""
    @color.setter
    def color(self, value: ArrayLike) -> None: ...


class Mesh:
    """Triangles of one convex or ball, as views of the frame's own arrays."""
    @property
    def vertices(self) -> NDArray[np.float32]:
        """Positions (n, 3), float32, relative to `origin`."""
    @property
    def normals(self) -> NDArray[np.float32]:
        """Unit normals (n, 3), float32."""
    @property
    def looks(self) -> NDArray[np.uint32]:
        """Appearance of each vertex (n), uint32: 0 on the original surface, 1 on faces that a
        break made."""
    @property
    def indices(self) -> NDArray[np.uint32]:
        """Vertices of triangles (m, 3), uint32, counter-clockwise seen from outside."""
    @property
    def origin(self) -> NDArray[np.float64]:
        """Point that vertices are relative to."""
    @property
    def material(self) -> int:
        """Index of the material."""


class Overlap:
    """A convex or ball that overlaps a volume."""
    @property
    def body(self) -> Optional[int]:
        """Key of the body; None for the ground."""
    @property
    def slot(self) -> int:
        """Number of the convex within the body."""


class Piece:
    """A piece of a broken solid, in the coordinates of the solid. Its arrays are read-only views."""
    @property
    def vertices(self) -> NDArray[np.float64]:
        """Vertices of the surface (n, 3), float64."""
    @property
    def triangles(self) -> NDArray[np.uint32]:
        """Vertices of triangles (m, 3), uint32, counter-clockwise seen from outside; the surface
        is closed."""
    @property
    def is_inside(self) -> NDArray[np.bool_]:
        """True for triangles that the break made (m), bool."""
    @property
    def volume_m3(self) -> float:
        """Volume in m³."""
    @property
    def centroid(self) -> NDArray[np.float64]:
        """Centre of volume."""
    @property
    def asset(self) -> Asset:
        """The piece as an asset, for worlds."""


class Recorder:
    """Writes frames to a recording (.take); a context manager that closes it."""
    def __init__(self, file: Union[str, os.PathLike]) -> None:
        """Creates the file."""
    def take(self, frame: Frame) -> None:
        """Adds a frame."""
    def close(self) -> None:
        """Writes what is left, and closes the file."""
    def __enter__(self) -> Recorder:
        ...
    def __exit__(self, *args) -> None:
        ...


class Recording:
    """An iterator over the frames of a recording."""
    def __iter__(self) -> Recording:
        ...
    def __next__(self) -> Frame:
        ...
    def __len__(self) -> int:
        ...
    def seek(self, frame: int) -> None:
        """Sets the frame that comes next, from 0 on."""
    @property
    def damage(self) -> str:
        """Description of the damage found so far; empty if there is none."""
    @property
    def is_complete(self) -> bool:
        """True if the run finished."""


class Renderer:
    """Draws frames off screen, on the thread that made it."""
    def __init__(self, width: int = 1280, height: int = 720, view_mode: str = 'materials', samples: int = 1, transparent: bool = False, hud: bool = False, layers: List[str] = [], gl: str = 'auto') -> None:
        """Makes a renderer. view_mode, samples, layers and gl are as in `sunder render`."""
    def draw(self, frame: Frame, before: Frame = None, eye: Optional[ArrayLike] = None, target: Optional[ArrayLike] = None, fov_rad: Optional[float] = None) -> NDArray[np.uint8]:
        """Returns the image of a frame (height, width, 3), uint8, sRGB; of 4 channels if
        transparent. before: the previous frame, for motion blur. eye, target, fov_rad: a camera
        in place of the scene's."""
    @property
    def layers(self) -> Dict[str, Any]:
        """Data layers of the image drawn last, as arrays by name."""
    @property
    def description(self) -> str:
        """Context, driver and version of OpenGL."""


class Scene:
    """All inputs of a run: materials, solids, balls and a script."""
    def __init__(self) -> None:
        """Makes a scene of the ground plane alone, with the built-in materials."""
    @property
    def name(self) -> str:
        """Name in messages."""
    @name.setter
    def name(self, value: str) -> None: ...
    @property
    def description(self) -> str:
        """One sentence about the scene."""
    @description.setter
    def description(self, value: str) -> None: ...
    @property
    def warnings(self) -> List[str]:
        """Problems of the scene's input files."""
    @property
    def duration_s(self) -> float:
        """Duration of the run of the program."""
    @duration_s.setter
    def duration_s(self, value: float) -> None: ...
    @property
    def gravity(self) -> NDArray[np.float64]:
        """Acceleration by gravity in m/s²."""
    @gravity.setter
    def gravity(self, value: ArrayLike) -> None: ...
    @property
    def seed(self) -> int:
        """Seed of everything random."""
    @seed.setter
    def seed(self, value: int) -> None: ...
    @property
    def planar(self) -> bool:
        """True if the scene moves in the plane z = 0."""
    @property
    def limits(self) -> Limits:
        """Limits of the run."""
    @property
    def accuracy(self) -> Accuracy:
        """Step, substeps and sweeps, and their preset."""
    @property
    def ground_friction(self) -> float:
        """Coefficient of friction of the ground plane."""
    @ground_friction.setter
    def ground_friction(self, value: float) -> None: ...
    @property
    def ground_height_m(self) -> float:
        """Height of the ground plane."""
    @ground_height_m.setter
    def ground_height_m(self, value: float) -> None: ...
    @property
    def eye(self) -> NDArray[np.float64]:
        """Position of the camera."""
    @eye.setter
    def eye(self, value: ArrayLike) -> None: ...
    @property
    def target(self) -> NDArray[np.float64]:
        """Point that the camera looks at."""
    @target.setter
    def target(self, value: ArrayLike) -> None: ...
    @property
    def fov_rad(self) -> float:
        """Vertical field of view of the camera."""
    @fov_rad.setter
    def fov_rad(self, value: float) -> None: ...
    @property
    def materials(self) -> List[Material]:
        """Materials by index. The list is a copy: assign it, or call add_material()."""
    @materials.setter
    def materials(self, value: List[Material]) -> None: ...
    @property
    def solids(self) -> int:
        """Number of solids."""
    @property
    def balls(self) -> int:
        """Number of balls."""
    def add_material(self, material: Material) -> int:
        """Adds a material, or replaces that of the same name. Returns its index."""
    def add_solid(self, asset: Asset, origin: ArrayLike = (0, 0, 0), rotation: ArrayLike = (0, 0, 0, 1), velocity: ArrayLike = (0, 0, 0), angular_velocity: ArrayLike = (0, 0, 0), name: str = '') -> int:
        """Adds a solid, with the origin of the asset at `origin`; rotation is a quaternion x, y,
        z, w. Returns the key that it will have in a world."""
    def add_ball(self, center: ArrayLike, radius_m: float = 0.5, material: Union[str, int] = 'steel', velocity: ArrayLike = (0, 0, 0), name: str = '') -> None:
        """Adds a ball. The keys of balls in a world follow those of the solids."""
    def copy(self) -> Scene:
        """Returns a copy, which shares the geometry of the solids."""


class StateHash:
    """A hash of the states of a run: that of the program, if it takes the frame at the start and
    one every 1/60 s."""
    def __init__(self) -> None:
        """Makes the hash of no frames."""
    def take(self, frame: Frame) -> None:
        """Adds the state of a frame."""
    def hex(self) -> str:
        """Returns 16 hexadecimal digits over all frames."""


class World:
    """A running simulation that a program acts on and asks. Bodies are known by keys, which are
    never used again; wrong keys raise InputError. One thread uses a world at a time; several
    worlds may run in several threads."""
    def __init__(self, scene: Scene, threads: int = 0, particles: bool = True) -> None:
        """Makes a world of a copy of the scene. threads: 0 for one per processor; results have the
        same bits for any number. particles: False for neither debris nor dust."""
    def step(self, dt_s: float = 1 / 60) -> None:
        """Advances by a time from 1e-6 to 0.1 s. Other Python threads run meanwhile."""
    def run(self, duration_s: float, on_frame: Optional[Callable[..., Any]] = None) -> None:
        """Advances by a time in steps of 1/60 s. Calls on_frame(world) after each of them, and
        stops if the call returns False. A keyboard interrupt stops it, too."""
    def copy(self) -> World:
        """Returns a world in the same state, which goes on with the same bits: to roll back, keep
        a copy. A planar world cannot be copied."""
    def save(self) -> bytes:
        """Returns the state as bytes, for restore(); worlds in equal states have equal bytes. A
        planar world cannot be saved. Worlds can be pickled in this way."""
    @staticmethod
    def restore(saved: bytes, threads: int = 0) -> World:
        """Returns a world in the state that save() of the same version has returned, in this or
        another process; it goes on with the same bits."""
    @property
    def time_s(self) -> float:
        """Time in s."""
    @property
    def warnings(self) -> List[str]:
        """Warnings about the scene."""
    def add_material(self, material: Material) -> int:
        """Adds a material. Returns its index."""
    def add_solid(self, asset: Asset, origin: ArrayLike = (0, 0, 0), rotation: ArrayLike = (0, 0, 0, 1), velocity: ArrayLike = (0, 0, 0), angular_velocity: ArrayLike = (0, 0, 0), name: str = '', category: int = 1, mask: int = 4294967295, user_data: int = 0) -> int:
        """Adds a solid, with the origin of the asset at `origin`; rotation is a quaternion x, y,
        z, w. Two bodies collide if the category of each has a bit in the mask of the other.
        Returns the key of the body."""
    def add_ball(self, center: ArrayLike, radius_m: float = 0.5, material: Union[str, int] = 'steel', velocity: ArrayLike = (0, 0, 0), name: str = '', category: int = 1, mask: int = 4294967295, user_data: int = 0) -> int:
        """Adds a ball. Returns its key."""
    def add_joint(self, kind: str, a: Optional[int], b: Optional[int], at: ArrayLike, to: Optional[ArrayLike] = None, axis: ArrayLike = (0, 0, 1), breaking_N: float = ..., breaking_Nm: float = ..., collide: bool = False) -> int:
        """Joins two bodies, or a body and the world (None), in their present poses. kind: ball,
        hinge, fixed, distance or rope. at: anchor on a; to: anchor on b of distance and rope.
        Returns the key of the joint."""
    def shoot(self, start: ArrayLike, velocity: ArrayLike, radius_m: float = 0.2, material: Union[str, int] = 'steel', time_s: float = 0.0, name: str = '') -> None:
        """Adds a ball that appears at a time; in the next step if that has passed."""
    def blast(self, center: ArrayLike, radius_m: float = 4.0, impulse_Ns_m2: float = 1000.0, tnt_kg: Optional[float] = None, in_air: bool = False, cover: bool = False, time_s: float = 0.0) -> None:
        """Ignites a blast: an impulse per area on every face turned to the centre, or the wave of
        a charge of tnt_kg on the ground, or in the air. cover: nearer bodies shield others."""
    def drive(self, bodies: List[int], velocity: Optional[ArrayLike] = None, force_N: float = 1000000.0, angular_velocity: Optional[ArrayLike] = None, torque_Nm: float = 1000000.0, time_s: float = 0.0, until_s: float = ...) -> None:
        """Holds bodies at a velocity by limited force, an angular velocity by limited torque, or
        both, until a time, or until they break."""
    def remove(self, body: int) -> None:
        """Removes a body."""
    def remove_joint(self, joint: int) -> None:
        """Removes a joint."""
    def set_motion(self, body: int, origin: Optional[ArrayLike] = None, rotation: Optional[ArrayLike] = None, velocity: Optional[ArrayLike] = None, angular_velocity: Optional[ArrayLike] = None) -> None:
        """Sets the pose and velocities of a body that is not anchored, and wakes it; None: as they
        are."""
    def move_to(self, body: int, origin: Optional[ArrayLike] = None, rotation: Optional[ArrayLike] = None, duration_s: float = 1.0) -> None:
        """Moves a body evenly to a pose within a time, as a kinematic body: of infinite mass, and
        unbreakable. It stays there until it is moved on or released."""
    def release(self, body: int) -> None:
        """Frees a kinematic body, or removes all anchors of an anchored one. It keeps its key."""
    def apply_impulse(self, body: int, impulse: ArrayLike, point: Optional[ArrayLike] = None) -> None:
        """Applies an impulse in N s at a point; None: at the centre of mass."""
    def break_at(self, body: int, point: ArrayLike, direction: ArrayLike, energy_J: float, pattern: Optional[str] = None) -> None:
        """Breaks a body in the next step, as an impact that does this work at the point of the
        body nearest to `point` would; by a pattern such as "voronoi:50" in place of its
        material's."""
    def set_user_data(self, body: int, user_data: int) -> None:
        """Sets a number that pieces inherit."""
    def set_filter(self, body: int, category: int = 1, mask: int = 4294967295) -> None:
        """Sets what the body and its pieces collide with."""
    def __len__(self) -> int:
        ...
    @property
    def bodies(self) -> Bodies:
        """All bodies at present, copied once per step; its arrays are views of that copy."""
    def body(self, key: int) -> Body:
        """Returns a body. Raises InputError if it is gone."""
    def contains(self, key: int) -> bool:
        """Returns True if a body is in the world."""
    def __contains__(self, arg0: int) -> bool:
        ...
    def contains_joint(self, key: int) -> bool:
        """Returns True if a joint is in the world."""
    def contacts(self, body: int) -> List[Contact]:
        """Returns the contacts of a body that carry load."""
    def cast(self, start: ArrayLike, direction: ArrayLike, most_m: float = 1000000.0, radius_m: float = 0.0, mask: int = 4294967295, ground: bool = True, accepts: Optional[Callable[..., Any]] = None) -> Optional[CastHit]:
        """Returns the first point that a ray meets, or a ball of this radius; None if there is
        none. mask: categories that are found. accepts(key): False for bodies that are not
        found."""
    def cast_all(self, start: ArrayLike, direction: ArrayLike, most_m: float = 1000000.0, radius_m: float = 0.0, mask: int = 4294967295, ground: bool = True, accepts: Optional[Callable[..., Any]] = None) -> List[CastHit]:
        """Returns all convexes and balls that a ray meets, by distance. mask: categories that are
        found. accepts(key): False for bodies that are not found."""
    def overlap(self, center: ArrayLike, radius_m: float, mask: int = 4294967295, ground: bool = True, accepts: Optional[Callable[..., Any]] = None) -> List[Overlap]:
        """Returns what overlaps a ball. mask: categories that are found. accepts(key): False for
        bodies that are not found."""
    def overlap_box(self, low: ArrayLike, high: ArrayLike, mask: int = 4294967295, ground: bool = True, accepts: Optional[Callable[..., Any]] = None) -> List[Overlap]:
        """Returns what overlaps a box. mask: categories that are found. accepts(key): False for
        bodies that are not found."""
    @property
    def materials(self) -> List[str]:
        """Names of the materials by index."""
    @property
    def events(self) -> Events:
        """Changes during the last step, and between it and the step before."""
    def report_hits(self, least_m_s: float) -> None:
        """Has `events` list hits of at least this closing speed from now on; inf: none."""
    @property
    def report(self) -> Dict[str, Any]:
        """Counts, times and sums of the last step, with the names of the program's JSON."""
    def frame(self) -> Frame:
        """Returns the present state to draw, store or read."""
    def state_hash(self) -> str:
        """Returns 16 hexadecimal digits: equal digits, equal states. StateHash is for whole runs."""


def builtin_materials() -> List[Material]:
    """Returns the materials that every scene begins with."""


def fracture(solid: Union[Union[str, os.PathLike], Asset], pattern: Union[str, Material] = 'voronoi:30', point: Optional[ArrayLike] = None, radius_m: Optional[float] = None, energy_J: float = 0.0, seed: int = 1) -> List[Piece]:
    """Breaks an asset, or the mesh of a file, once, as `sunder fracture` does, and returns its
    pieces.

    pattern: voronoi:N[,FALLOFF], web:RINGSxSPOKES, radial:N, brick:X,Y,Z, slabs:N, grid:N, or
    an .obj file of cells; or a Material, which breaks by the pattern that it has for an impact
    of energy_J. point: the impact; None: the middle. radius_m: distance from it within which
    the solid breaks; None: all of it."""


def load_scene(scene: Union[str, os.PathLike], preset: str = 'realtime', set: Dict[str, Any] = ...) -> Scene:
    """Loads a scene by its name, or a scene file. preset: draft, realtime, accurate or reference.
    set: values by dotted key, such as {"scene.seed": 2}."""


def parse_scene(text: str, preset: str = 'realtime', set: Dict[str, Any] = ..., file: Union[str, os.PathLike] = 'scene.toml') -> Scene:
    """Returns the scene that a text describes. Messages name `file`, and files that the scene
    names are sought in its folder."""


def read_recording(file: Union[str, os.PathLike]) -> Recording:
    """Opens a recording (.take); iterating over it gives its frames."""


def render(frame: Frame, width: int = 1280, height: int = 720, view_mode: str = 'materials', samples: int = 1, transparent: bool = False, hud: bool = False, eye: Optional[ArrayLike] = None, target: Optional[ArrayLike] = None, fov_rad: Optional[float] = None, gl: str = 'auto') -> NDArray[np.uint8]:
    """Returns the image of one frame (height, width, 3), uint8, sRGB; of 4 channels if
    transparent. For many frames a Renderer is faster."""


def scene_names() -> List[str]:
    """Returns the names of the scenes that come with Sunder, sorted."""


def set_threads(count: int) -> None:
    """Sets the number of threads of all worlds that were made with threads=0, and of loading and
    fracture. 0: one per processor."""
