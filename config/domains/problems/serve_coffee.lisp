; A mug of coffee waits on the counter; guest1 sits west of table1. Leads to Listing 6.1 of
; S. Rockel's dissertation (University of Hamburg, 2015), step by step.

(defproblem serve_coffee restaurant
  (
    ; the robot: somewhere on the floor, torso down, arms opened after start-up, hands empty
    (RobotAt floorareatamsrestaurant1)
    (HasTorsoPosture torsodownposture)
    (HasArmPosture leftarm1 armuntuckedposture) (HasArmPosture rightarm1 armuntuckedposture)
    (Holding leftarm1 nothing) (Holding rightarm1 nothing)

    ; guests
    (At guest1 sittingareawesttable1) (At guest2 sittingareaeasttable1)
    (At guest3 sittingareanorthtable2) (At guest4 sittingareasouthtable2)

    ; objects
    (Type coffee mug1) (Type mug mug1) (Type mug mug2)
    (On mug1 placingareaeastrightcounter1) (On mug2 placingareaeastrightcounter1))

  ((serve_coffee_to_guest guest1)))
