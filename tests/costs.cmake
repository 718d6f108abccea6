# Seconds that the slowest tests take on two processors. ctest starts them first, so that none is
# alone at the end; on a clean checkout it knows no earlier times. Those of more than ten seconds are
# labelled long, too, and left to test.sh --all.
set_tests_properties("soak: random scenes under random shots stay finite and keep their mass"
  PROPERTIES COST 120)
set_tests_properties("extreme 8" PROPERTIES COST 130)
set_tests_properties("extreme 11" PROPERTIES COST 110)
set_tests_properties("extreme 3" PROPERTIES COST 60)
set_tests_properties("truth 8" PROPERTIES COST 45)
set_tests_properties("truth 18" PROPERTIES COST 36)
set_tests_properties("truth 19" PROPERTIES COST 32)
set_tests_properties("truth 20" PROPERTIES COST 32)
set_tests_properties("truth 27" PROPERTIES COST 27)
set_tests_properties("truth 43" PROPERTIES COST 24)
set_tests_properties("extreme 10" PROPERTIES COST 28)
set_tests_properties("truth 27 at the default preset" PROPERTIES COST 24 LABELS "truth_default;long")
set_tests_properties("truth 20 at the default preset" PROPERTIES COST 17 LABELS "truth_default;long")
set_tests_properties(Golden.DrawingAndSimulationAreUnchanged
  PROPERTIES COST 78 LABELS "golden;long")
set_tests_properties(Collapse.BuildingsOfListedPartsCollapseWhenTheyAreShot
  PROPERTIES COST 49 LABELS "truth;long")
set_tests_properties(SteelHall.BendsBeforeItFalls PROPERTIES COST 41 LABELS "truth;long")
set_tests_properties(Collapse.ATempleFallsWithoutItsFrontRow PROPERTIES COST 30 LABELS "truth;long")
set_tests_properties(GoldenFaults.NoNumberOfThreadsAndNoContextGivesAFalseFailure
  PROPERTIES COST 26 LABELS "golden;long")
set_tests_properties(Invariants.hold_over_ten_thousand_random_breaks
  PROPERTIES COST 24 LABELS "property;long")
set_tests_properties(Chain.HoldsABallOfTenThousandLinksAtEveryPreset
  PROPERTIES COST 23 LABELS "unit;long")
set_tests_properties(Extremes.AThousandBodiesInOnePlacePartWithBoundedEnergyAndWork
  PROPERTIES COST 22 LABELS "extreme;long")
set_tests_properties(World.ARestoredWorldGoesOnWithTheSameBits PROPERTIES COST 9)
set_tests_properties(Collapse.ABridgeFallsWithoutItsPier PROPERTIES COST 18 LABELS "truth;long")
set_tests_properties(MeshCommands.EveryGoodMeshBreaksSoundly
  PROPERTIES COST 17 LABELS "program;long")
set_tests_properties(Conservation.PiecesOfABreakInMotionSeparateWithoutGainingEnergy
  PROPERTIES COST 12 LABELS "truth;long")
set_tests_properties(Collapse.AWallThatWasShotThroughHasAHoleAndStands
  PROPERTIES COST 11 LABELS "truth;long")
set_tests_properties(Golden.EveryPairOfDifferentBaselinesIsToldApart
  PROPERTIES COST 11 LABELS "golden;long")
set_tests_properties(HardMeshes.LongWorkReportsItsProgressUnlessQuiet PROPERTIES COST 9)
set_tests_properties(Slivers.OfAPaneUnderFireStayFiniteAndGainNoEnergy PROPERTIES COST 9)
set_tests_properties(Conservation.AThousandRandomBreaksInMotionKeepMassAndMomentumAndGainNoEnergy
  PROPERTIES COST 8)
set_tests_properties(Collapse.SlabsBreakWhenOtherSlabsStrikeThem PROPERTIES COST 7)
set_tests_properties(GoldenFaults.ADifferentCameraOrColorsOfTheSceneAreFoundAndNamed
  PROPERTIES COST 7)
set_tests_properties(Bending.FramesUnderImpactKeepMass PROPERTIES COST 7)
set_tests_properties(Program.SettingsOfARecordingMayChangeTheViewOnly PROPERTIES COST 7)
set_tests_properties(Film.ARecordingIsDrawnByEveryCamera PROPERTIES COST 7)
set_tests_properties(Program.AStoppedCommandKeepsItsOutputsAndLeavesNoOtherFiles PROPERTIES COST 7)
set_tests_properties(Bending.ThrownBarsKeepMassAndMomentaAndGainNoEnergy PROPERTIES COST 7)
set_tests_properties(Extremes.AHundredThousandBodiesGiveTheSameBitsForAnyNumberOfThreads
  PROPERTIES COST 7)
set_tests_properties(Trace.WorkOfOtherThreadsInALoopHasTheNameOfTheEnclosingSpan PROPERTIES COST 7)
set_tests_properties(Golden.TheReportedCommandsMakeTheSameGoldenAgain PROPERTIES COST 7)
set_tests_properties(SoundPieces.OfFiveHundredGeneratedMeshes
  PROPERTIES COST 36 LABELS "unit;long")
set_tests_properties(SoundPieces.OfRealMeshes PROPERTIES COST 20 LABELS "unit;long")
set_tests_properties(Vacd.OfRealMeshesKeepsItsInvariants PROPERTIES COST 7)
set_tests_properties(Exports.OfDamagedMeshesHaveEveryEdgeInTwoFaces PROPERTIES COST 7)
set_tests_properties(Bending.NoJointStaysAtARemovedBody PROPERTIES COST 6)
set_tests_properties(Repair.AnySoupEndsInTime PROPERTIES COST 6)
set_tests_properties(Film.OptionsThatDoNotApplyAreRefusedByName PROPERTIES COST 6)
set_tests_properties(Rubble.SleepsWithinThreeSecondsOfRestWithoutMorePenetration PROPERTIES COST 5)
set_tests_properties(Lanes.GiveTheSameBitsForAnyNumberOfThreads PROPERTIES COST 5)
set_tests_properties(Golden.AMissingBaselineFailsUntilItIsAccepted PROPERTIES COST 5)
