"""Flows of liquids.py by OpenFOAM's simpleFoam: the same mesh, walls, inlets and
model of turbulence, steady. What a model and a grid give by themselves."""

from caseBuilder import RunningCase, foamText, header

STRESS = "div((nuEff*dev2(T(grad(U)))))"
SOLVER = {"solver": "smoothSolver", "smoother": "symGaussSeidel",
          "tolerance": 1e-9, "relTol": 0.1}


def fields(inlets, inside, k, epsilon):
    """Name -> class, dimensions, value inside, conditions by patch. Velocities
    of the inlets by side, and inside at the start; out at xmax; a side ymax that
    is no inlet is a lid without stress"""
    zero, empty = {"type": "zeroGradient"}, {"type": "empty"}
    names = ["xmin", "xmax", "ymax", "walls"]

    def field(kind, dims, inside, **conditions):
        text = f"uniform {foamText(inside)}"
        return (f"vol{kind}Field", f"[{dims} 0 0 0 0]", text, {
            "frontAndBack": empty, **{name: {
                "value": text, "inletValue": text, **conditions.get(name, zero)}
                for name in names}})

    def scalar(dims, value, wall):
        return field("Scalar", dims, value, walls={"type": wall},
                     xmax={"type": "inletOutlet"},
                     **{side: {"type": "fixedValue"} for side in inlets})
    return {
        "U": field("Vector", "0 1 -1", inside, **{
            "ymax": {"type": "slip"}, "walls": {"type": "noSlip"},
            **{side: {"type": "fixedValue", "value": f"uniform {foamText(U)}"}
               for side, U in inlets.items()}}),
        "p": field("Scalar", "0 2 -2", 0, xmax={"type": "fixedValue"}),
        "k": scalar("0 2 -2", k, "kqRWallFunction"),
        "epsilon": scalar("0 2 -3", epsilon, "epsilonWallFunction"),
        "nut": field("Scalar", "0 2 -1", 0, walls={"type": "nutkWallFunction"},
                     **{side: {"type": "calculated"}
                        for side in ("xmin", "xmax", "ymax")})}


def solve(path, setup, model, inlets, inside, k, epsilon, nu):
    """Velocity and k of the cells, by row and column of the mesh, at the end,
    and velocity 1000 iterations before it, or None if that is converged"""
    gauss = "bounded Gauss "
    files = {
        "system/blockMeshDict": setup.blockMeshDict(),
        "system/controlDict": {
            "application": "simpleFoam", "startFrom": "startTime",
            "startTime": 0, "stopAt": "endTime", "endTime": 5000, "deltaT": 1,
            "writeControl": "timeStep", "writeInterval": 1000,
            "writeFormat": "ascii", "writePrecision": 10},
        "system/fvSchemes": {
            "ddtSchemes": {"default": "steadyState"},
            "gradSchemes": {"default": "Gauss linear"},
            "divSchemes": {
                "div(phi,U)": gauss + "linearUpwind grad(U)",
                "div(phi,k)": gauss + "limitedLinear 1",
                "div(phi,epsilon)": gauss + "limitedLinear 1",
                STRESS: "Gauss linear"},
            "laplacianSchemes": {"default": "Gauss linear corrected"},
            "interpolationSchemes": {"default": "linear"},
            "snGradSchemes": {"default": "corrected"},
            "wallDist": {"method": "meshWave"}},
        "system/fvSolution": {
            "solvers": {"p": {"solver": "GAMG", "smoother": "GaussSeidel",
                              "tolerance": 1e-8, "relTol": 0.05},
                        **{f: SOLVER for f in ("U", "k", "epsilon")}},
            "SIMPLE": {"residualControl": {
                "p": 1e-5, "U": 1e-6, "k": 1e-6, "epsilon": 1e-6}},
            "relaxationFactors": {
                "fields": {"p": 0.3},
                "equations": {"U": 0.6, "k": 0.5, "epsilon": 0.5}}},
        "constant/transportProperties": {
            "transportModel": "Newtonian", "nu": nu},
        "constant/turbulenceProperties": {
            "simulationType": "RAS", "RAS": {
                "RASModel": model, "turbulence": True, "printCoeffs": True}}}
    texts = {name: header(name.split("/")[-1]) + foamText(content)
             for name, content in files.items()}
    for name, (kind, dims, inside, patches) in fields(
            inlets, inside, k, epsilon).items():
        texts[f"0/{name}"] = header(name, kind) + foamText({
            "dimensions": dims, "internalField": inside,
            "boundaryField": patches})
    for name, text in texts.items():
        (path/name).parent.mkdir(parents=True, exist_ok=True)
        (path/name).write_text(text)

    case = RunningCase(path, setup)
    case.run("blockMesh")
    text = case.run("simpleFoam").text
    U, k = (case.case.lattice(case.times[-1], name)[2] for name in ("U", "k"))
    if "SIMPLE solution converged" in text:
        return U, k, None
    return U, k, case.case.lattice(case.times[-2], "U")[2]
