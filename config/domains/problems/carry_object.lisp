; A pepper mill, tall enough to topple, is to go from the counter to table1 on the robot's tray. How
; fast to drive with it is imagined.

(defproblem carry_object restaurant
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
    (Type peppermill peppermill1)
    (On peppermill1 placingareaeastrightcounter1))

  ((carry_object_on_tray peppermill1 counter1 table1)))
