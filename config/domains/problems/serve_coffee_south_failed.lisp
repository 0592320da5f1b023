; As serve_coffee.lisp after its first ten steps, when imagination has found that the mug cannot be
; placed from the south of the table. Leads to Listing 6.2 of the dissertation: its steps 11 to 16.

(defproblem serve_coffee_south_failed restaurant
  (
    ; the robot: before the counter, ready to drive with the mug in its right hand
    (RobotAt premanipulationareaeastcounter1)
    (HasTorsoPosture torsomiddleposture)
    (HasArmPosture leftarm1 armcarryposture) (HasArmPosture rightarm1 armcarryposture)
    (Holding leftarm1 nothing) (Holding rightarm1 mug1)

    ; guests
    (At guest1 sittingareawesttable1) (At guest2 sittingareaeasttable1)
    (At guest3 sittingareanorthtable2) (At guest4 sittingareasouthtable2)

    ; objects
    (Type coffee mug1) (Type mug mug1) (Type mug mug2)
    (On mug2 placingareaeastrightcounter1)

    ; what imagination found
    (imagined_failure place_object mug1 rightarm1 placingareawestrighttable1))

  ((serve_coffee_to_guest guest1)))
