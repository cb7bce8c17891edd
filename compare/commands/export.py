"""The command ``export``: a model to paste into a robot, chosen for a wanted error."""

import math
from dataclasses import replace
from decimal import ROUND_CEILING, Context
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from analytic.problem.errors import InputError
from compare.commands.options import CaseName, flag, option, require_fraction, words
from compare.commands.output import check_own, output_folder, waiting
from compare.read.case import load_case
from compare.read.job import Job
from mujoco_models.allowed import BeamKind

if TYPE_CHECKING:
    from analytic import Beam
    from compare.simulate.prescription import Prescription

_SPEED = 0.05  # L/T1; what is slower is nearer to rest
_OUT = Path("whisker.xml")
_UPWARDS = Context(prec=2, rounding=ROUND_CEILING)
_MATERIALS = 2, 3  # modulus, radius, and a tube's inner one


def export(
    case: CaseName,
    out: Annotated[
        Path, option("The file, *.xml or *.urdf.", "FILE", "whisker.xml", "--out")
    ] = _OUT,
    error: Annotated[
        float, option("Largest rms of a reading, relative to its largest magnitude.", "RMS")
    ] = 0.01,
    speed: Annotated[
        float | None, option("Of the foot [L/T1].", "V", "[motion]'s, or 0.05 without one")
    ] = None,
    beam: Annotated[
        BeamKind | None, option("MuJoCo's beam.", default="the case's, or chain")
    ] = None,
    material: Annotated[
        str | None,
        option("Young's modulus, radius, and a tube's inner one, instead of the case's EI and "
               "radius: '210 GPa,0.25 mm'.", "E,R[,R]"),
    ] = None,
    density: Annotated[
        str | None,
        option("Of the material, as '7850 kg/m^3'.", "RHO", "[motion]'s, or such that T1 is 1"),
    ] = None,
    obstacle: Annotated[bool, flag("--obstacle", "Write the case's object, too.")] = False,
    urdf: Annotated[
        bool, flag("--urdf", "Write URDF, as for *.urdf: a chain without springs.")
    ] = False,
) -> bool:  # fmt: skip
    """Write a model for a robot, chosen for a wanted error.

    Segments, time step and contacts are the coarsest with which what is written, swept past the
    case's object by MuJoCo alone, is so near to rest. In the units of the case, SI if it has units.
    """
    if out.suffix not in (".xml", ".urdf"):
        raise InputError("--out", out, "named *.xml or *.urdf", "rename it")
    require_fraction("--error", error, "0.01")
    if out == _OUT:
        check_own(out, "In a robot:")
    with waiting("loading"):
        from compare.commands import terminal
        from compare.simulate.prescription import LADDER, prescribe
        from mujoco_models.beams.available import require
        from mujoco_models.export.sweep import beside
        from mujoco_models.export.urdf import LACKING, as_urdf, require_chain
        from mujoco_models.motion import Motion
    if (bare := urdf or out.suffix == ".urdf") and obstacle:
        raise InputError("--obstacle", "given", "for MJCF alone", "URDF holds the whisker only")
    job = load_case(case)
    if not isinstance(job, Job):
        remedy = "put one in its place: the whisker is chosen by a sweep past it"
        raise InputError(f"{case}: [body]", "given", "a [profile], in the plane", remedy)
    if job.model is not None:
        raise InputError("CASE", case, "one without a [model]", "that is a model already")
    kind = beam or job.settings.beam
    require(kind)
    if bare:
        require_chain(replace(job.settings, beam=kind))
    made, solid = _of_material(job.case.beam, material)
    period = _period(case, made, solid, density)
    motion = job.motion or Motion(speed=_SPEED)
    motion = replace(motion, integrator="discrete", speed=motion.speed if speed is None else speed)
    wanted = replace(job.case, beam=made)
    with output_folder(out.parent):
        with terminal.progress("models", len(LADDER)) as advance:
            found = prescribe(wanted, kind, motion, period, error, advance)
        whisker = replace(found.whisker, case=wanted)
        said = _lines(found, error, made.si)
        if bare:
            text, said = as_urdf(whisker), [*said, LACKING]
        else:
            text = (beside(whisker) if obstacle else whisker).xml(*said)
        for line in said:
            terminal.print_line(line)
        terminal.keep(out, text)
    return True


def _of_material(beam: "Beam", material: str | None) -> tuple["Beam", float]:
    """The vibrissa of a material, and the share of its section that is solid."""
    if material is None:
        return beam, 1.0
    texts = words(material)
    if len(texts) not in _MATERIALS:
        raise InputError("--material", repr(material), "two or three values",
                         "as '210 GPa,0.25 mm', with a tube's inner radius last")  # fmt: skip
    modulus, *radii = (
        _quantity("--material", text, unit, beam.si)
        for text, unit in zip(texts, ("Pa", "m", "m"), strict=False)
    )
    outer, inner = (*radii, 0.0)[:2]
    if not 0 <= inner < outer:
        raise InputError("--material", repr(material), "with radii r > r_inner >= 0", "swap them")
    rigidity = modulus * math.pi * (outer**4 - inner**4) / 4
    return replace(beam, flexural_rigidity=rigidity, radius=outer), 1 - (inner / outer) ** 2


def _period(case: str, beam: "Beam", solid: float, density: str | None) -> float:
    """T1 in the unit of time that belongs to those of the case."""
    from compare.read.motion import MotionTable, first_period
    from compare.read.toml import TomlFile

    named = not case.endswith(".toml")
    tables = {} if named else TomlFile.read(Path(case), "case file").tables
    stated = MotionTable.model_validate(tables.get("motion", {}))
    found = stated.density
    if density is not None:
        found = _quantity("--density", density, "kg/m^3", beam.si)
        if not (found > 0 and math.isfinite(found)):
            raise InputError("--density", density, "positive", "7850 kg/m^3 is steel")
    if found is not None:
        return first_period(beam, found) * math.sqrt(solid)
    if stated.period is None and beam.si:
        raise InputError("--density", "missing", "given where the vibrissa has units",
                         "as --density '7850 kg/m^3', or under [motion]")  # fmt: skip
    return float(stated.period or 1.0)


def _quantity(name: str, text: str, unit: str, si: bool) -> float:
    """A number in the units of the case, or a text with a unit if these are SI."""
    from compare.read.units import in_si

    try:
        return float(text)
    except ValueError:
        if not si:
            raise InputError(name, repr(text), "a number where the case has no units",
                             "give the case's lengths with units, too") from None  # fmt: skip
        return in_si(text, unit)


def _lines(found: "Prescription", error: float, si: bool) -> list[str]:
    from compare.simulate.prescription import REFERENCE, REFERENCE_OFF

    whisker = found.whisker
    settings, motion, period = whisker.settings, whisker.motion, whisker.period
    second, stiffness = (" s", " N/m") if si else ("", "")
    most = upwards(found.error)
    return [
        f"A {settings.beam} of {settings.segments} segments, swept at {motion.speed:g} L/T1, T1 = "
        f"{period:.4g}{second}: {most} rms at most, of {error:g} asked for: from MuJoCo "
        f"at rest with {REFERENCE} segments, and {REFERENCE_OFF:g} that those are off.",
        f"Time step {motion.timestep * period:.4g}{second} (T1/{1 / motion.timestep:g}), "
        f"integrator {motion.integrator}, contacts of {whisker.contact_stiffness:.4g}{stiffness}.",
    ]


def upwards(x: float) -> str:
    """Two digits of a bound, rounded up."""
    return f"{float(_UPWARDS.create_decimal(repr(x))):.1e}"
