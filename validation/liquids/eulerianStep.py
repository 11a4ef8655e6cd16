"""The backward-facing step of liquids.py by OpenFOAM's simpleFoam: the same
mesh, walls, inlet and model of turbulence, steady. What a model and a grid give
by themselves."""

from caseBuilder import RunningCase, foamText, header

STRESS = "div((nuEff*dev2(T(grad(U)))))"
SOLVER = {"solver": "smoothSolver", "smoother": "symGaussSeidel",
          "tolerance": 1e-9, "relTol": 0.1}


def fields(U, k, epsilon):
    """Name -> class, dimensions, value inside, conditions by patch"""
    zero, empty = {"type": "zeroGradient"}, {"type": "empty"}

    def field(kind, dims, inside, value, conditions):
        text = f"uniform {foamText(value)}"
        return (f"vol{kind}Field", f"[{dims} 0 0 0 0]", f"uniform "
                f"{foamText(inside)}", {
                    name: {**c, "value": text, "inletValue": text}
                    for name, c in conditions.items()})

    def scalar(dims, value, wall):
        return field("Scalar", dims, value, value, {
            "xmin": {"type": "fixedValue"}, "xmax": {"type": "inletOutlet"},
            "ymax": zero, "walls": {"type": wall}, "frontAndBack": empty})
    return {
        "U": field("Vector", "0 1 -1", (U, 0, 0), (U, 0, 0), {
            "xmin": {"type": "fixedValue"}, "xmax": zero,
            "ymax": {"type": "slip"}, "walls": {"type": "noSlip"},
            "frontAndBack": empty}),
        "p": field("Scalar", "0 2 -2", 0, 0, {
            "xmin": zero, "xmax": {"type": "fixedValue"}, "ymax": zero,
            "walls": zero, "frontAndBack": empty}),
        "k": scalar("0 2 -2", k, "kqRWallFunction"),
        "epsilon": scalar("0 2 -3", epsilon, "epsilonWallFunction"),
        "nut": field("Scalar", "0 2 -1", 0, 0, {
            **{side: {"type": "calculated"}
               for side in ("xmin", "xmax", "ymax")},
            "walls": {"type": "nutkWallFunction"}, "frontAndBack": empty})}


def solve(path, setup, model, U, k, epsilon, nu):
    """Velocity and k of the cells, by row and column of the mesh"""
    gauss = "bounded Gauss "
    files = {
        "system/blockMeshDict": setup.blockMeshDict(),
        "system/controlDict": {
            "application": "simpleFoam", "startFrom": "startTime",
            "startTime": 0, "stopAt": "endTime", "endTime": 5000, "deltaT": 1,
            "writeControl": "timeStep", "writeInterval": 5000,
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
    for name, (kind, dims, inside, patches) in fields(U, k, epsilon).items():
        texts[f"0/{name}"] = header(name, kind) + foamText({
            "dimensions": dims, "internalField": inside,
            "boundaryField": patches})
    for name, text in texts.items():
        (path/name).parent.mkdir(parents=True, exist_ok=True)
        (path/name).write_text(text)

    case = RunningCase(path, setup)
    case.run("blockMesh")
    text = case.run("simpleFoam").text
    if "SIMPLE solution converged" not in text:
        raise AssertionError(f"{path}: simpleFoam did not converge")
    end = case.times[-1]
    return [case.case.lattice(end, name)[2] for name in ("U", "k")]
